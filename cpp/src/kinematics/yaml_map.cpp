#include "kinematics/yaml_map.hpp"

#include <algorithm>
#include <cmath>

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

YamlMap::YamlMap(const YamlValue& value) : value_(value) {
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

bool YamlMap::has(const std::string& key) const { return value_.node()[key].IsDefined(); }

YamlValue YamlMap::at(const std::string& key, const std::string& add, ErrorCode code) {
  const YAML::Node node = value_.node()[key];
  if (!node.IsDefined()) {
    value_.refuse("key \"" + key + "\" is missing", {"add " + add}, code);
  }
  return {node, value_.source(), path_of(key)};
}

void YamlMap::finish(const std::vector<std::string>& known) const {
  for (const auto& entry : value_.node()) {
    const YamlValue key(entry.first, value_.source(), value_.path());
    if (std::find(known.begin(), known.end(), key.text()) != known.end()) continue;
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    key.refuse("unknown key \"" + key.text() + "\"", {"known keys here: " + list});
  }
}

}  // namespace viapoint
