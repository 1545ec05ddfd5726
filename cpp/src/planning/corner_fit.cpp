#include "planning/corner_fit.hpp"

#include <algorithm>
#include <optional>

#include "planning/tool_limits.hpp"
#include "viapoint/path/position_limits.hpp"

namespace viapoint::planning {
namespace {

constexpr int kShrinks = 6;

std::optional<double> smaller(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a) return b;
  if (!b) return a;
  return std::min(*a, *b);
}

/// True when the blend keeps position and coupled limits all the way. Legs inside the limits do
/// not imply it: a corner bulges out where a leg is curved.
bool keeps_limits(const JointPiece& blend, const JointLimits& limits) {
  return !piece_position_violation(blend, limits);
}

}  // namespace

Corner fit_corner(const RobotModel& robot, const JointPath& before, const Leg& after,
                  const MoveOptions& options, double room_before, double room_after) {
  const ForwardKinematics* arm = robot.has_kinematics() ? &robot.forward() : nullptr;
  Zone zone = options.zone;
  Corner corner;
  for (int attempt = 0; attempt < kShrinks; ++attempt) {
    corner = round_corner(arm, before, after.path, zone, room_before, room_after);
    if (!corner.possible) return corner;
    if (keeps_limits(corner.blend, robot.limits())) {
      if (attempt > 0) corner.reason = "a larger corner leaves the joint limits";
      corner.blend.scale =
          std::min(before.pieces().back().scale, after.path.pieces().front().scale);
      if (arm != nullptr)
        limit_tool(robot, corner.blend,
                   {smaller(options.speed, after.options.speed),
                    smaller(options.acceleration, after.options.acceleration)});
      return corner;
    }
    zone.size *= 0.5;
  }
  corner.possible = false;
  corner.reason = "every corner within the zone leaves the joint limits";
  return corner;
}

}  // namespace viapoint::planning
