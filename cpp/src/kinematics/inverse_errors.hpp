/// @file
/// What every inverse solver checks and says alike.
#pragma once

#include <string>
#include <vector>

#include "kinematics/joint_turns.hpp"
#include "viapoint/core/pose.hpp"

namespace viapoint {

/// Every answer reproduces its pose to this [m] and [rad].
inline constexpr double kPoseTolerance = 1e-9;

/// Distance between two poses.
struct PoseError {
  double position = 0.0;  ///< [m]
  double angle = 0.0;     ///< [rad]
  [[nodiscard]] bool within(double tolerance) const {
    return position <= tolerance && angle <= tolerance;
  }
};
[[nodiscard]] PoseError pose_error(const Pose& a, const Pose& b);

/// What is asked for: a pose, or a position alone.
struct InverseTask {
  explicit InverseTask(const Pose& pose) : goal(pose), position_only(false) {}
  explicit InverseTask(const Eigen::Vector3d& position)
      : goal(Eigen::Translation3d(position)), position_only(true) {}

  Pose goal;
  bool position_only;

  [[nodiscard]] PoseError error_of(const Pose& reached) const {
    PoseError found = pose_error(reached, goal);
    if (position_only) found.angle = 0.0;
    return found;
  }
};

/// True for a pose that require_pose() lets pass. Real-time: safe.
[[nodiscard]] bool is_pose(const Pose& pose);
/// @throws MotionError(kBadArgument, kNotARotation)
void require_pose(const Pose& pose);
/// @throws MotionError(kBadArgument)
void require_position(const Eigen::Vector3d& position);
/// @throws MotionError(kBadArgument)
void require_joints(const JointVector& q, int joints, const char* what);

/// "195°" or "0.125 m": to 1e-9, so that a value and the limit that it breaks never look alike.
[[nodiscard]] std::string joint_value(JointType type, double value);

/// @throws MotionError(kOutsideLimits) about the branch that comes nearest to the limits
[[noreturn]] void refuse_outside_limits(const ForwardKinematics& forward, const JointTurns& turns,
                                        const std::vector<JointVector>& branches);
/// @throws MotionError(kUnreachable); `distance` is how far out of reach [m]
[[noreturn]] void refuse_unreachable(const std::string& what, double distance);

}  // namespace viapoint
