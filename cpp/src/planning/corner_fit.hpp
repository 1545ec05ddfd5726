/// @file
/// One corner between two legs, within its zone, the joint limits and the speed wishes.
#pragma once

#include "planning/leg.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/corner.hpp"

namespace viapoint::planning {

/// @param before the leg that arrives, in the section's scale of s; @param after the one that
/// leaves, in its own. @param room_before, room_after what may be cut off each, in its own s
[[nodiscard]] Corner fit_corner(const RobotModel& robot, const JointPath& before, const Leg& after,
                                const MoveOptions& options, double room_before, double room_after);

}  // namespace viapoint::planning
