#include "planning/corner_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "viapoint/path/position_limits.hpp"

namespace viapoint::planning {
namespace {

constexpr int kShrinks = 6;

/// Suprema over a piece of ‖p'‖ and ‖p''‖ of the tool point by s.
struct ToolRates {
  double first = 0.0;
  double second = 0.0;
};

/// Bounds by subintervals: the value in the middle and a Lipschitz remainder.
ToolRates bound_tool_rates(const ForwardKinematics& arm, const JointPiece& piece) {
  constexpr int kParts = 64;
  const double half = 0.5 * piece.length / kParts;
  const Eigen::Index n = piece.joints();
  // sup |q'''| over the piece: its polynomial in u has coefficients 6, 24, 60.
  JointVector third = 6.0 * piece.coefficients.row(3).cwiseAbs().transpose() +
                      24.0 * piece.coefficients.row(4).cwiseAbs().transpose() +
                      60.0 * piece.coefficients.row(5).cwiseAbs().transpose();
  third /= piece.length * piece.length * piece.length;
  JointVector travel(n);
  for (Eigen::Index i = 0; i < n; ++i) travel[i] = piece.coefficients.col(i).cwiseAbs().sum();
  double weight = arm.reach_bound(travel).maxCoeff();
  for (int i = 0; i < arm.joints(); ++i) {
    if (arm.type(i) == JointType::kPrismatic) weight = std::max(weight, 1.0);
  }

  ToolRates rates;
  for (int k = 0; k < kParts; ++k) {
    const PathPoint middle = piece.at((2 * k + 1) * half);
    const JointVector q2 = middle.q2.cwiseAbs() + half * third;
    const JointVector q1 = middle.q1.cwiseAbs() + half * q2;
    const double sum = q1.sum();
    const double second = weight * (sum * sum + q2.sum());
    const Jacobian jacobian = arm.jacobian(arm.frames(middle.q));
    const double first = (jacobian.topRows<3>() * middle.q1).norm() + half * second;
    rates.first = std::max(rates.first, first);
    rates.second = std::max(rates.second, second);
  }
  return rates;
}

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
      if (arm != nullptr) limit_tool(robot, corner.blend, options, after.options);
      return corner;
    }
    zone.size *= 0.5;
  }
  corner.possible = false;
  corner.reason = "every corner within the zone leaves the joint limits";
  return corner;
}

void limit_tool(const RobotModel& robot, JointPiece& blend, const MoveOptions& before,
                const MoveOptions& after) {
  const std::optional<double> speed = smaller(before.speed, after.speed);
  const std::optional<double> acceleration = smaller(before.acceleration, after.acceleration);
  if (!speed && !acceleration) return;
  const ToolRates rates = bound_tool_rates(robot.forward(), blend);
  if (speed && rates.first > 0.0) {
    blend.rate_limit = std::min(blend.rate_limit, *speed / rates.first);
  }
  if (acceleration && rates.first > 0.0) {
    // ‖p'' ṡ² + p' s̈‖ <= a, half of it for each.
    blend.rate_change_limit = std::min(blend.rate_change_limit, 0.5 * *acceleration / rates.first);
    if (rates.second > 0.0) {
      blend.rate_limit = std::min(blend.rate_limit, std::sqrt(0.5 * *acceleration / rates.second));
    }
  }
}

}  // namespace viapoint::planning
