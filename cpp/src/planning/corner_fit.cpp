#include "planning/corner_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "viapoint/path/position_limits.hpp"

namespace viapoint::planning {
namespace {

constexpr int kShrinks = 6;

/// In a corner the limits of both legs count; the lower speed is held if it is one to be held.
ToolLimits both(const ToolLimits& a, const ToolLimits& b) {
  const double speed = std::min(a.speed, b.speed);
  const bool held = (a.hold_speed && a.speed == speed) || (b.hold_speed && b.speed == speed);
  ToolLimits lower;
  lower.speed = speed;
  lower.acceleration = std::min(a.acceleration, b.acceleration);
  lower.angular_speed = std::min(a.angular_speed, b.angular_speed);
  lower.angular_acceleration = std::min(a.angular_acceleration, b.angular_acceleration);
  lower.hold_speed = held;
  return lower;
}

/// True when the blend keeps position and coupled limits all the way. Legs inside the limits do
/// not imply it: a corner bulges out where a leg is curved.
bool keeps_limits(const JointPiece& blend, const JointLimits& limits) {
  return !piece_position_violation(blend, limits);
}

/// Length of a joint line in joint space; nothing for any other leg and for one that limits the
/// tool.
std::optional<double> free_length(const JointPath& leg) {
  const JointPiece& piece = leg.pieces().front();
  const bool line = leg.pieces().size() == 1 && piece.kind == PieceKind::kJointLine;
  if (!line || piece.tool.any()) return std::nullopt;
  return piece.coefficients.row(1).norm();
}

}  // namespace

Corner fit_corner(const RobotModel& robot, const Leg& before, const JointPath& tail,
                  const Leg& after, double room_before, double room_after) {
  const ForwardKinematics* arm = robot.has_kinematics() ? &robot.forward() : nullptr;
  // What merging has used of the zone is not there for the corner, unless that counts from a point.
  const bool of_legs = before.options.zone.kind != ZoneKind::kRadius;
  const double merged = std::max(before.merged.distance, after.merged.distance);
  const double turned = std::max(before.merged.turn, after.merged.turn);
  Zone zone = before.options.zone;
  if (of_legs) {
    zone.size -= merged;
    zone.angle -= turned;
  }
  Corner corner;
  for (int attempt = 0; attempt < kShrinks; ++attempt) {
    corner = round_corner(arm, tail, after.path, zone, room_before, room_after);
    if (!corner.possible) return corner;
    if (keeps_limits(corner.blend, robot.limits())) {
      if (corner.short_of_room && merged > 0.0) corner.reason.clear();
      if (attempt > 0) corner.reason = "a larger corner leaves the joint limits";
      if (of_legs) {
        corner.used += merged;
        if (zone.bounds_angle()) corner.used_angle += turned;
      }
      corner.tool_deviation += std::max(before.merged.at_tool, after.merged.at_tool);
      corner.blend.scale = std::min(tail.pieces().back().scale, after.path.pieces().front().scale);
      corner.blend.tool = both(before.tool_limits(), after.tool_limits());
      return corner;
    }
    zone.size *= 0.5;
    zone.angle *= 0.5;
  }
  corner.possible = false;
  corner.reason = "every corner within the zone leaves the joint limits";
  return corner;
}

bool surely_pays(const Corner& corner, const JointPath& tail, const JointPath& after) {
  constexpr double kLeastCut = 0.05;
  const std::optional<double> before_length = free_length(tail), after_length = free_length(after);
  if (!before_length || !after_length) return false;
  if (tail.pieces().front().scale != after.pieces().front().scale) return false;
  const double cut_before = *before_length * corner.cut_before / tail.length();
  const double cut_after = *after_length * corner.cut_after / after.length();
  return std::min(cut_before, cut_after) >= kLeastCut * std::max(*before_length, *after_length);
}

}  // namespace viapoint::planning
