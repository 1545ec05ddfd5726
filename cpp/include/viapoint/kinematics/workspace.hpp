/// @file
/// Where an arm's tool can be.
#pragma once

#include <optional>
#include <vector>

#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint {

/// Part of a ray, from its start [m].
struct Stretch {
  double from = 0.0;
  double to = 0.0;
};

/// The parts of the ray start + s · direction, s ≥ 0, that the tool's point can be at, within the
/// joint limits: with the orientation given, or with any. Looked at in kReachSteps steps up to the
/// farthest any joint vector could bring it, each end then bisected to 1e-9 m: a gap, or a stretch,
/// narrower than a step can be missed.
/// @param start, direction in the base frame [m]; the direction need not be a unit vector
/// @throws MotionError(kBadArgument) for a direction of no length; kUncontrolled without kinematics
/// Real-time: not. Threads: any.
[[nodiscard]] std::vector<Stretch> reach(const RobotModel& robot, const Eigen::Vector3d& start,
                                         const Eigen::Vector3d& direction,
                                         const std::optional<Eigen::Matrix3d>& rotation);

inline constexpr int kReachSteps = 128;

}  // namespace viapoint
