/// @file
/// Seven joints on a tool curve, with what the pose leaves open chosen over the whole of it.
#pragma once

#include <optional>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/task_curve.hpp"

namespace viapoint::planning {

/// Whether `robot` has one joint more than `hold` takes, and a search that knows it.
[[nodiscard]] bool leaves_one_open(const RobotModel& robot, Hold hold);

/// The curve as joint pieces, from `start` on, with the open joint chosen with the end in mind: the
/// shortest way through its values at places along the curve (follow_poses), smoothed, then
/// followed with the proof that every curve has. First few places, then many.
/// @param goal the joints to arrive at; null where any with the curve's last pose do
/// @return nothing where no choice was found. @pre leaves_one_open(robot, how.hold)
[[nodiscard]] std::optional<Insertion> insert_with_choice(const RobotModel& robot,
                                                          const TaskCurve& curve,
                                                          const JointVector& start,
                                                          const JointVector* goal,
                                                          const InsertionOptions& how);

}  // namespace viapoint::planning
