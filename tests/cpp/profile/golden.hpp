/// @file
/// The golden numbers of the textbook, computed apart from this project.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace viapoint {

inline nlohmann::json golden(const std::string& key) {
  std::ifstream file(std::string(VIAPOINT_TEST_DATA) + "/golden.json");
  return nlohmann::json::parse(file).at(key);
}

}  // namespace viapoint
