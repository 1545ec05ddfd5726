/// @file
/// The built-in arms and seeded joint vectors within their limits.
#pragma once

#include <map>
#include <random>
#include <string>

#include "viapoint/kinematics/robot_description.hpp"
#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint {

inline constexpr const char* kArms[] = {"puma560", "two_link", "rpp",   "scara",
                                        "ur5e",    "panda",    "iiwa14"};

inline RobotPtr arm(const std::string& name) {
  return RobotModel::make(
      load_description(std::string(VIAPOINT_TEST_ROBOTS) + "/" + name + ".yaml"));
}

/// Uniform between the position limits.
inline JointVector random_joints(const RobotModel& robot, std::mt19937_64& generator) {
  JointVector q(robot.joints());
  for (int i = 0; i < robot.joints(); ++i) {
    q[i] = std::uniform_real_distribution<double>(robot.limits().position_min[i],
                                                  robot.limits().position_max[i])(generator);
  }
  return q;
}

/// Largest element-wise distance of two poses [m, and about rad].
inline double pose_distance(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

}  // namespace viapoint
