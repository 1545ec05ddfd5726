/// @file
/// The golden numbers of the textbook, computed apart from this project.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "viapoint/core/pose.hpp"

namespace viapoint {

/// What the file has under a key of its first level.
inline nlohmann::json golden(const std::string& key) {
  std::ifstream file(std::string(VIAPOINT_TEST_DATA) + "/golden.json");
  return nlohmann::json::parse(file).at(key);
}

/// A 4x4 matrix written row by row.
inline Pose golden_pose(const nlohmann::json& rows) {
  Pose pose = Pose::Identity();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      pose.matrix()(i, j) = rows[static_cast<size_t>(i)][static_cast<size_t>(j)].get<double>();
    }
  }
  return pose;
}

}  // namespace viapoint
