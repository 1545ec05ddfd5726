/// @file
/// What a Cartesian move asks of the tool: from the step and the joints where it begins to a curve.
#pragma once

#include <memory>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/task_curve.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::planning {

/// Below this a move goes nowhere [rad or m].
inline constexpr double kNowhere = 1e-9;
/// How near a curve must come to the joints it was asked for [rad or m].
inline constexpr double kSameBranch = 1e-3;

struct ToolWay {
  std::unique_ptr<const TaskCurve> curve;
  Hold hold = Hold::kPose;
  Target goal;  ///< where it ends; for Hold::kWrist it tells the wrist joints at the end
  /// Where the goal is given as joints, the move must arrive at them and not at another branch.
  bool joints_count = false;
};

/// @throws MotionError: kUncontrolled for an arm without kinematics, kHalfTurn, kDegenerateCurve,
/// kZeroLength, kJointLimit, kBadArgument
[[nodiscard]] ToolWay way_of(const LinMove& move, const RobotModel& robot,
                             const JointVector& start);
[[nodiscard]] ToolWay way_of(const CircMove& move, const RobotModel& robot,
                             const JointVector& start);
[[nodiscard]] ToolWay way_of(const TurnMove& move, const RobotModel& robot,
                             const JointVector& start);

/// The pose of a target; the orientation at `start` where it is a position alone.
[[nodiscard]] Pose pose_of(const RobotModel& robot, const Target& target, const JointVector& start);
/// Which coordinates a move holds that treats the orientation so and ends at `goal`.
[[nodiscard]] Hold hold_of(Orientation orientation, const Target& goal);
/// The constant turn from one orientation to the other over a length.
/// @throws MotionError(kHalfTurn)
[[nodiscard]] std::unique_ptr<const OrientationCurve> least_turn(const Eigen::Matrix3d& from,
                                                                 const Eigen::Matrix3d& to,
                                                                 double length);
/// An orientation whose z axis is that of `to`, by the least turn from `from`.
/// @throws MotionError(kHalfTurn)
[[nodiscard]] Eigen::Matrix3d least_turned_axis(const Eigen::Matrix3d& from,
                                                const Eigen::Matrix3d& to);
/// @throws MotionError(kUncontrolled)
void require_kinematics(const RobotModel& robot);
/// Refuses joints of the wrong number, not finite, or outside the limits.
void require_within_limits(const RobotModel& robot, const JointVector& q, const char* what);
/// A joint's value with its unit, for messages.
[[nodiscard]] std::string in_words(const RobotModel& robot, int joint, double value);

}  // namespace viapoint::planning
