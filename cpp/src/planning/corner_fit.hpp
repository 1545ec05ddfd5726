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

}  // namespace viapoint::planning
