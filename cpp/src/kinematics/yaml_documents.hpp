/// @file
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace viapoint {

/// What a text holds, as far as it matters where one document is wanted.
struct YamlDocuments {
  YAML::Node first;     ///< undefined or null where there is none
  int count = 0;        ///< 0, 1, or 2 for more
  int second_line = 0;  ///< where the second one begins, from 1
};

/// Not YAML::LoadAll, which never ends where it meets a "," or a bracket that was not opened.
/// @throws YAML::Exception
[[nodiscard]] YamlDocuments load_documents(const std::string& text);

}  // namespace viapoint
