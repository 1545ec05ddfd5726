/// @file
/// Joints that follow a timed motion of the tool, as quintic pieces of time.
#pragma once

#include <vector>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/drive_transform.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::planning {

struct TimedPieces {
  std::vector<TrajectoryPiece> pieces;  ///< break where parts of the motion meet
  double position_error = 0.0;          ///< largest at the checked instants [m]
  double angle_error = 0.0;             ///< [rad]; 0 where the orientation is free
};

/// Continues `first` along the motion: at each knot Newton's iteration from the joints predicted
/// there, so that the branch is kept, with q̇ = J⁻¹ v and q̈ = J⁻¹ (v̇ − J̇ q̇); between knots the
/// quintic with these ends. Knots draw closer until every piece is within kTimedPoseError at its
/// quarters. Joint limits are left aside.
/// @param oriented false: only the tool's position is held
/// @throws MotionError with `time` [s]: kUnreachable where the motion leaves the workspace,
/// kSingular where the joints cannot follow, kUncontrolled for an arm with too few joints
[[nodiscard]] TimedPieces follow(const RobotModel& robot, const DriveMotion& motion,
                                 const JointVector& first, bool oriented);

}  // namespace viapoint::planning
