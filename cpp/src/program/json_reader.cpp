#include "program/json_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viapoint/core/error.hpp"

namespace viapoint::program_json {

bool Node::has(const char* key) const { return json_->is_object() && json_->contains(key); }

Node Node::at(const char* key) const {
  require_object();
  if (!json_->contains(key)) refuse(std::string("a member \"") + key + "\"");
  return {(*json_)[key], path_.empty() ? key : path_ + "." + key, source_};
}

Node Node::item(size_t index) const {
  return {(*json_)[index], path_ + "[" + std::to_string(index) + "]", source_};
}

void Node::only(std::initializer_list<std::string_view> keys) const {
  require_object();
  for (const auto& [key, value] : json_->items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string known;
    for (const std::string_view k : keys) known += (known.empty() ? "" : ", ") + std::string(k);
    refuse("no member \"" + key + "\"; known are " + known);
  }
}

void Node::require_object() const {
  if (!json_->is_object()) refuse("an object {...}");
}

size_t Node::array_size() const {
  if (!json_->is_array()) refuse("an array [...]");
  return json_->size();
}

double Node::number() const {
  if (!json_->is_number()) refuse("a number");
  const double value = json_->get<double>();
  if (!std::isfinite(value)) refuse("a finite number");
  return value;
}

int Node::integer() const {
  if (!json_->is_number_integer()) refuse("an integer");
  const auto value = json_->get<std::int64_t>();
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    refuse("an integer of 32 bits");
  }
  return static_cast<int>(value);
}

bool Node::boolean() const {
  if (!json_->is_boolean()) refuse("true or false");
  return json_->get<bool>();
}

std::string Node::text() const {
  if (!json_->is_string()) refuse("a text");
  return json_->get<std::string>();
}

JointVector Node::joint_vector() const {
  const size_t size = array_size();
  if (size == 0 || size > static_cast<size_t>(kMaxJoints)) {
    refuse("1 to " + std::to_string(kMaxJoints) + " numbers, one a joint");
  }
  JointVector values(static_cast<Eigen::Index>(size));
  for (size_t i = 0; i < size; ++i) values[static_cast<Eigen::Index>(i)] = item(i).number();
  return values;
}

void Node::refuse(const std::string& expected) const {
  std::string got = json_->dump();
  constexpr size_t kShown = 60;
  if (got.size() > kShown) {
    size_t end = kShown;  // not within a character of several bytes
    while (end > 0 && (static_cast<unsigned char>(got[end]) & 0xC0U) == 0x80U) --end;
    got = got.substr(0, end) + "…";
  }
  Problem problem;
  problem.code = ErrorCode::kBadProgram;
  problem.file = source_;
  problem.message =
      (path_.empty() ? "the program" : path_) + ": expected " + expected + ", got " + got;
  problem.ways_out = {"correct it in the file, or write the file anew: program.save(path)"};
  throw MotionError(std::move(problem));
}

}  // namespace viapoint::program_json
