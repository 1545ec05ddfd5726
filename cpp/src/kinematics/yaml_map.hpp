/// @file
/// A YAML map read strictly: every key is asked for by name, every value checked, what is left over
/// is refused, and each error says file, line, key and what was expected.
#pragma once

#include <yaml-cpp/yaml.h>

#include <set>
#include <string>
#include <vector>

#include "viapoint/core/error.hpp"

namespace viapoint {

/// A node and where it stands: file, and the keys that lead to it.
class YamlValue {
 public:
  YamlValue(const YAML::Node& node, std::string source, std::string path)
      : node_(node), source_(std::move(source)), path_(std::move(path)) {}

  [[nodiscard]] double number() const;
  [[nodiscard]] int whole_number() const;
  [[nodiscard]] std::string text() const;
  /// @param size exact number of entries, or -1 for any
  [[nodiscard]] std::vector<double> numbers(int size) const;
  [[nodiscard]] std::vector<std::string> texts() const;
  [[nodiscard]] std::vector<YamlValue> list() const;
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const YAML::Node& node() const { return node_; }
  [[nodiscard]] const std::string& source() const { return source_; }

  /// Throws MotionError with this value's file and line.
  [[noreturn]] void refuse(const std::string& what, std::vector<std::string> ways_out = {},
                           ErrorCode code = ErrorCode::kBadRobot) const;

 private:
  YAML::Node node_;
  std::string source_;
  std::string path_;
};

class YamlMap {
 public:
  /// @param known the keys that may be there: another one is a slip of the pen, or nobody's
  YamlMap(const YamlValue& value, std::vector<std::string> known);

  [[nodiscard]] bool has(const std::string& key) const;
  /// The value of a key that must be there; `add` says what to write when it is not.
  [[nodiscard]] YamlValue at(const std::string& key, const std::string& add,
                             ErrorCode code = ErrorCode::kBadRobot);
  /// @pre has(key)
  [[nodiscard]] YamlValue at(const std::string& key) { return at(key, ""); }
  /// Refuses every key that is not known.
  void finish() const;
  [[nodiscard]] const YamlValue& value() const { return value_; }

 private:
  [[nodiscard]] std::string path_of(const std::string& key) const;
  [[nodiscard]] bool knows(const std::string& key) const;

  YamlValue value_;
  std::vector<std::string> known_;
};

}  // namespace viapoint
