#include "kinematics/yaml_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace viapoint {
namespace {

std::string kind_of(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return "\"" + node.Scalar() + "\"";
    case YAML::NodeType::Sequence:
      return "a list of " + std::to_string(node.size());
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "nothing";
  }
}

/// Letters to change, add or leave out to make one of the other (Levenshtein 1966).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

/// Whether `typed` may be a slip of the pen for `meant`: one letter of a short key, two of a longer
/// one. Much longer ones are none, and comparing them takes long.
bool is_slip(const std::string& typed, const std::string& meant) {
  constexpr std::size_t kShort = 4, kLongest = 40;
  if (meant.size() < 3 || typed.size() > kLongest) return false;
  return distance(typed, meant) <= (meant.size() <= kShort ? 1 : 2);
}

}  // namespace

void YamlValue::refuse(const std::string& what, std::vector<std::string> ways_out,
                       ErrorCode code) const {
  Problem problem;
  problem.code = code;
  problem.message = path_.empty() ? what : path_ + ": " + what;
  problem.ways_out = std::move(ways_out);
  problem.file = source_;
  if (!node_.Mark().is_null()) problem.line = node_.Mark().line + 1;
  throw MotionError(std::move(problem));
}

double YamlValue::number() const {
  double value = 0.0;
  if (!node_.IsScalar() || !YAML::convert<double>::decode(node_, value) || std::isnan(value)) {
    refuse("expected a number, got " + kind_of(node_));
  }
  return value;
}

int YamlValue::whole_number() const {
  int value = 0;
  if (!node_.IsScalar() || !YAML::convert<int>::decode(node_, value)) {
    refuse("expected a whole number, got " + kind_of(node_));
  }
  return value;
}

std::string YamlValue::text() const {
  if (!node_.IsScalar()) refuse("expected text, got " + kind_of(node_));
  return node_.Scalar();
}

std::vector<YamlValue> YamlValue::list() const {
  if (!node_.IsSequence()) refuse("expected a list, got " + kind_of(node_));
  std::vector<YamlValue> out;
  for (size_t i = 0; i < node_.size(); ++i) {
    out.emplace_back(node_[i], source_, path_ + "[" + std::to_string(i) + "]");
  }
  return out;
}

std::vector<double> YamlValue::numbers(int size) const {
  const std::string expected =
      "expected a list of " + (size < 0 ? "" : std::to_string(size) + " ") + "numbers";
  if (!node_.IsSequence() || (size >= 0 && static_cast<int>(node_.size()) != size)) {
    refuse(expected + ", got " + kind_of(node_));
  }
  std::vector<double> out;
  for (const YamlValue& entry : list()) out.push_back(entry.number());
  return out;
}

std::vector<std::string> YamlValue::texts() const {
  std::vector<std::string> out;
  for (const YamlValue& entry : list()) out.push_back(entry.text());
  return out;
}

YamlMap::YamlMap(const YamlValue& value, std::vector<std::string> known)
    : value_(value), known_(std::move(known)) {
  if (!value.node().IsMap()) value.refuse("expected keys and values, got " + kind_of(value.node()));
  std::set<std::string> seen;
  for (const auto& entry : value.node()) {
    const YamlValue key(entry.first, value.source(), value.path());
    if (!seen.insert(key.text()).second) key.refuse("key \"" + key.text() + "\" is there twice");
  }
}

std::string YamlMap::path_of(const std::string& key) const {
  return value_.path().empty() ? key : value_.path() + "." + key;
}

bool YamlMap::knows(const std::string& key) const {
  return std::find(known_.begin(), known_.end(), key) != known_.end();
}

bool YamlMap::has(const std::string& key) const { return value_.node()[key].IsDefined(); }

YamlValue YamlMap::at(const std::string& key, const std::string& add, ErrorCode code) {
  const YAML::Node node = value_.node()[key];
  if (!node.IsDefined()) {
    for (const auto& entry : value_.node()) {
      const YamlValue other(entry.first, value_.source(), value_.path());
      if (knows(other.text()) || !is_slip(other.text(), key)) continue;
      other.refuse("key \"" + key + "\" is missing, there is \"" + other.text() + "\"",
                   {"write \"" + key + "\" for \"" + other.text() + "\"", "add " + add}, code);
    }
    value_.refuse("key \"" + key + "\" is missing", {"add " + add}, code);
  }
  return {node, value_.source(), path_of(key)};
}

void YamlMap::finish() const {
  for (const auto& entry : value_.node()) {
    const YamlValue key(entry.first, value_.source(), value_.path());
    if (knows(key.text())) continue;
    std::vector<std::string> ways_out;
    std::string list;
    for (const std::string& name : known_) {
      list += (list.empty() ? "" : ", ") + name;
      if (is_slip(key.text(), name)) ways_out.push_back("write \"" + name + "\"");
    }
    ways_out.push_back("known keys here: " + list);
    key.refuse("unknown key \"" + key.text() + "\"", std::move(ways_out));
  }
}

}  // namespace viapoint
