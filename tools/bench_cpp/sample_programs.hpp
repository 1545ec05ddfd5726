/// @file
/// Seeded programs for the PUMA 560, and for an arm of six joints without kinematics.
#pragma once

#include <cstdint>
#include <random>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::bench {

/// `moves` joint moves between random points well inside the limits, blended within 0.05 rad, and
/// back to the start.
[[nodiscard]] MotionProgram random_ptp(const RobotModel& robot, int moves, std::uint64_t seed);
/// `moves` straight lines between random poses in a box in front of the arm, the tool tilted by a
/// few degrees, blended within 20 mm. Such a program can be impossible.
[[nodiscard]] MotionProgram random_lin(const RobotModel& robot, int moves, std::uint64_t seed);
/// Six joints that take 2.1 2.1 2.6 4 4 6 rad/s, ten times that a second, and a hundred times that
/// a second squared.
[[nodiscard]] RobotPtr walking_robot();
/// 0.1 to 0.6 rad in a random direction.
[[nodiscard]] JointVector random_walk_step(int joints, std::mt19937_64& random);
/// `points` way-points, the start among them, 0.1 to 0.6 rad apart in random directions, each a
/// stop.
[[nodiscard]] MotionProgram random_walk(const RobotModel& robot, int points, std::uint64_t seed);

}  // namespace viapoint::bench
