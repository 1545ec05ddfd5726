/// @file
/// Programs on real robots, in few words.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "planning/script.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::testing_planner {

inline RobotPtr robot(const std::string& name) {
  return RobotModel::make(
      load_description(std::string(VIAPOINT_TEST_ROBOTS) + "/" + name + ".yaml"));
}

inline JointVector degrees(std::initializer_list<double> values) {
  JointVector q(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) q[i++] = value * kDegree;
  return q;
}

// The textbook's joints of A, B and C (§3).
inline JointVector puma_a() { return degrees({-100.4577, 70.6108, 48.3997, 0, 60.9896, 29.2746}); }
inline JointVector puma_b() {
  return degrees({-52.1158, -1.4358, 30.206, -121.3834, -11.4781, -178.4572});
}
inline JointVector puma_c() {
  return degrees({0.0955, 65.7969, 14.3196, 15.3377, -20.173, 30.0401});
}

}  // namespace viapoint::testing_planner
