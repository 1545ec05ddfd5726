#include "planning/corner_fit.hpp"

#include <algorithm>
#include <cmath>
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

/// In a corner the wishes of both legs count.
ToolWishes both(const ToolWishes& a, const ToolWishes& b) {
  return {smaller(a.speed, b.speed), smaller(a.acceleration, b.acceleration)};
}

/// True when the blend keeps position and coupled limits all the way. Legs inside the limits do
/// not imply it: a corner bulges out where a leg is curved.
bool keeps_limits(const JointPiece& blend, const JointLimits& limits) {
  return !piece_position_violation(blend, limits);
}

/// Length of a joint line in joint space; nothing for any other leg and for one with speed wishes.
std::optional<double> free_length(const JointPath& leg) {
  const JointPiece& piece = leg.pieces().front();
  const bool line = leg.pieces().size() == 1 && piece.kind == PieceKind::kJointLine;
  if (!line || std::isfinite(piece.rate_limit) || std::isfinite(piece.rate_change_limit)) {
    return std::nullopt;
  }
  return piece.coefficients.row(1).norm();
}

}  // namespace

Corner fit_corner(const RobotModel& robot, const Leg& before, const JointPath& tail,
                  const Leg& after, double room_before, double room_after) {
  const ForwardKinematics* arm = robot.has_kinematics() ? &robot.forward() : nullptr;
  Zone zone = before.options.zone;
  Corner corner;
  for (int attempt = 0; attempt < kShrinks; ++attempt) {
    corner = round_corner(arm, tail, after.path, zone, room_before, room_after);
    if (!corner.possible) return corner;
    if (keeps_limits(corner.blend, robot.limits())) {
      if (attempt > 0) corner.reason = "a larger corner leaves the joint limits";
      corner.blend.scale = std::min(tail.pieces().back().scale, after.path.pieces().front().scale);
      if (arm != nullptr) limit_tool(robot, corner.blend, both(before.wishes(), after.wishes()));
      return corner;
    }
    zone.size *= 0.5;
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
