/// @file
/// One corner between two legs, within its zone, the joint limits and the speed wishes.
#pragma once

#include "planning/leg.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/corner.hpp"

namespace viapoint::planning {

/// @param before the leg that arrives; @param tail what is left of it, in the section's scale of s
/// @param after the leg that leaves, in its own scale
/// @param room_before, room_after what may be cut off tail and after, each in its own s
[[nodiscard]] Corner fit_corner(const RobotModel& robot, const Leg& before, const JointPath& tail,
                                const Leg& after, double room_before, double room_after);

/// True where the corner is known to be quicker than a stop without timing either: between joint
/// lines under the same limits, cut back by a good part of the longer one. There a stop was quicker
/// by more than two per cent in 5 of 3653 random corners.
[[nodiscard]] bool surely_pays(const Corner& corner, const JointPath& tail, const JointPath& after);

}  // namespace viapoint::planning
