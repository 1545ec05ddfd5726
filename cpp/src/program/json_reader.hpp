/// @file
/// Reading JSON with errors that name the file, the place and what was expected.
#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint::program_json {

using Json = nlohmann::ordered_json;

/// A value and the way to it from the root, for messages: "steps[3].lin.pose".
class Node {
 public:
  Node(const Json& json, std::string path, std::string source)
      : json_(&json), path_(std::move(path)), source_(std::move(source)) {}

  [[nodiscard]] const Json& json() const { return *json_; }
  [[nodiscard]] bool has(const char* key) const;
  /// The member `key`, which must be there.
  [[nodiscard]] Node at(const char* key) const;
  [[nodiscard]] Node item(size_t index) const;
  /// Refuses members that are not among `keys`: a misspelt wish must not be ignored.
  void only(std::initializer_list<std::string_view> keys) const;

  void require_object() const;
  [[nodiscard]] size_t array_size() const;
  [[nodiscard]] double number() const;
  [[nodiscard]] int integer() const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] JointVector joint_vector() const;
  [[noreturn]] void refuse(const std::string& expected) const;

 private:
  const Json* json_;
  std::string path_;
  std::string source_;
};

}  // namespace viapoint::program_json
