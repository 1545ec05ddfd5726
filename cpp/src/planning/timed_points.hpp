/// @file
/// The points of a timed motion as joints or as poses, whatever they were given as.
#pragma once

#include <vector>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::planning {

/// Seconds from point to point, (k − 1,).
/// @throws MotionError(kBadArgument) for fewer than two points, and for a first point that is given
/// time (there is none before it)
[[nodiscard]] std::vector<double> durations_of(const TimedMove& move);

/// Joints of every point: a pose or position takes the branch nearest to the point before (the
/// first one to `start`), limits left aside for poses.
/// @throws MotionError of the inverse kinematics, or kBadArgument, naming the point
[[nodiscard]] std::vector<JointVector> joints_of(const RobotModel& robot, const JointVector& start,
                                                 const TimedMove& move);

/// A timed motion of the tool: its poses, and the joints it begins with.
struct ToolPoints {
  std::vector<Pose> poses;
  JointVector first;
  /// False where every point is a position alone: then the orientation is free, and the poses'
  /// rotations mean nothing.
  bool oriented = true;
};

/// @throws MotionError as joints_of(), and kUncontrolled for an arm without kinematics
[[nodiscard]] ToolPoints tool_points_of(const RobotModel& robot, const JointVector& start,
                                        const TimedMove& move);

}  // namespace viapoint::planning
