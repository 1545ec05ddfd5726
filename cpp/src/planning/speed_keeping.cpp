#include "planning/speed_keeping.hpp"

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "planning/tool_pace.hpp"
#include "planning/tool_way.hpp"
#include "viapoint/core/number_text.hpp"
#include "viapoint/path/tool_rates.hpp"

namespace viapoint::planning {
namespace {

/// Looked at on every piece: even, for Simpson's rule.
constexpr int kParts = 8;
/// A speed missed by less is as good as kept.
constexpr double kMissed = 1.01;

/// A place of the leg: how far along [m], what wants it slowest there, and how fast the tool may
/// speed up there by the joints' accelerations [m/s²].
struct Place {
  double at = 0.0;
  Ruling ruling;
  double acceleration = 0.0;
};

JointState state_at(const PathPoint& point, const Pace& pace) {
  const double square = pace.rate * pace.rate;
  return {point.q, point.q1 * pace.rate, point.q2 * square + point.q1 * pace.change,
          point.q3 * (square * pace.rate) + point.q2 * (3.0 * pace.rate * pace.change) +
              point.q1 * pace.jerk};
}

Place place_at(const RobotModel& robot, const JointPiece& unit, const ToolRates& rates, double u,
               double speed) {
  const JointLimits& limits = robot.limits();
  const RateAt linear = rate_at(rates.linear, u);
  const PathPoint point = unit.at(u);
  Place place;
  place.ruling.take(limits, unit.scale, state_at(point, pace_at_speed(linear, u, speed)));
  const double slowest = (point.q1.array().abs() / limits.acceleration.array()).maxCoeff();
  place.acceleration = unit.scale * linear.value.norm() / slowest;
  return place;
}

std::vector<Place> places_of(const RobotModel& robot, const Leg& leg, double speed) {
  std::vector<Place> places;
  double way = 0.0;
  for (JointPiece piece : leg.path.pieces()) {
    piece.length = 1.0;
    const ToolRates rates = tool_rates(robot.forward(), piece);
    const auto rate = [&](double u) { return rate_at(rates.linear, u).value.norm(); };
    for (int k = 0; k <= kParts; ++k) {
      const double u = static_cast<double>(k) / kParts, half = 0.5 / kParts;
      if (k > 0) {  // Simpson's rule
        way += (rate(u - 2.0 * half) + 4.0 * rate(u - half) + rate(u)) / (6.0 * kParts);
      }
      places.push_back(place_at(robot, piece, rates, u, speed));
      places.back().at = way;
    }
  }
  return places;
}

/// The place where the joints hold the tool back most, but for those where it could be no faster
/// coming from rest at an end of the leg.
std::optional<Place> slowest_of(std::span<const Place> places, double speed) {
  const double way = places.back().at;
  std::optional<Place> slowest;
  for (const Place& place : places) {
    const double kept = speed / place.ruling.slower;
    const double ramp = std::min(place.at, way - place.at);
    if (kept * kept >= 2.0 * place.acceleration * ramp) continue;
    if (!slowest || place.ruling.slower > slowest->ruling.slower) slowest = place;
  }
  return slowest;
}

}  // namespace

std::optional<Problem> speed_not_kept(const RobotModel& robot, const Leg& leg) {
  if (!leg.cartesian || !leg.options.speed || leg.options.process_speed) return std::nullopt;
  const double speed = *leg.options.speed;
  const std::vector<Place> places = places_of(robot, leg, speed);
  const double way = places.back().at;
  if (way < kNowhere) return std::nullopt;  // on the spot there is no speed to be kept
  const std::optional<Place> slowest = slowest_of(places, speed);
  if (!slowest || !(slowest->ruling.slower > kMissed)) return std::nullopt;
  Problem problem;
  problem.severity = Severity::kWarning;
  problem.code = ErrorCode::kVelocityLimit;
  problem.joint = slowest->ruling.joint;
  problem.share = slowest->at / way;
  problem.value = speed / slowest->ruling.slower;
  problem.limit = speed;
  char text[240];
  std::snprintf(text, sizeof text,
                "the joints cannot keep the speed of %.6g m/s: %.4g m along the way of %.4g m they "
                "hold the tool to %.4g m/s; what rules is the %s of joint %d",
                speed, slowest->at, way, *problem.value, slowest->ruling.limit.c_str(),
                *problem.joint + 1);
  problem.message = text;
  problem.ways_out = {"speed=" + rounded_down_text(*problem.value) + ", kept all along",
                      "another pose, in which the joints have less far to go",
                      "movej, where the way of the tool does not matter"};
  return problem;
}

}  // namespace viapoint::planning
