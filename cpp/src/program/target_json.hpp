/// @file
/// Where moves go and how the tool turns, as JSON.
#pragma once

#include <string>
#include <vector>

#include "program/json_reader.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::program_json {

/// The word that stands for a value in the file.
template <typename Enum>
struct Word {
  Enum value;
  const char* text;
};
template <typename Enum, size_t N>
const char* word_of(Enum value, const Word<Enum> (&words)[N]) {
  for (const auto& word : words) {
    if (word.value == value) return word.text;
  }
  return words[0].text;
}

template <typename Enum, size_t N>
Enum value_of(const Node& node, const Word<Enum> (&words)[N]) {
  const std::string text = node.text();
  std::string known;
  for (const auto& word : words) {
    if (text == word.text) return word.value;
    known += (known.empty() ? "" : ", ") + std::string(word.text);
  }
  node.refuse("one of " + known);
}

[[nodiscard]] Json json_of(const JointVector& q);
[[nodiscard]] Json json_of(const Eigen::Vector3d& vector);
[[nodiscard]] Json json_of(const Pose& pose);
[[nodiscard]] Json json_of(const Target& target);
[[nodiscard]] const char* word_of(Orientation orientation);

[[nodiscard]] Orientation orientation_of(const Node& node);
[[nodiscard]] Eigen::Vector3d vector_of(const Node& node);
/// A rotation to the last bit is left as it is: what was written reads back unchanged.
[[nodiscard]] Pose pose_of(const Node& node);
/// @param timed the target has its seconds beside it
[[nodiscard]] Target target_of(const Node& node, bool timed = false);

}  // namespace viapoint::program_json
