/// @file
/// Whether the joints can keep the tool's speed that a move asks for.
#pragma once

#include <optional>

#include "planning/leg.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint::planning {

/// A warning where running the leg steadily at its `speed` would break a joint's limit by more than
/// a hundredth; nothing else, and nothing for a process speed, whose proof tells every stretch.
/// Looks at the curve before corners, leaving out where the tool could be no faster coming from
/// rest at its ends: by samples, since every limit is proven later.
[[nodiscard]] std::optional<Problem> speed_not_kept(const RobotModel& robot, const Leg& leg);

}  // namespace viapoint::planning
