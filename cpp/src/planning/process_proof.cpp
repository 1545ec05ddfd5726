#include "planning/process_proof.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "viapoint/trajectory/tool_certificate.hpp"

namespace viapoint::planning {
namespace {

/// Rounding of a speed that is kept as a limit.
constexpr double kAbove = 1e-9;
/// A limit that wants the tool slower by no more than this if it held the speed is none in its way.
constexpr double kHoldable = 0.98;

Pace pace_of(const TrajectoryPiece& piece, double x) {
  const auto [u, first, second] = value_slope_bend(piece.timing, x);
  const auto& t = piece.timing;
  const double third = 6 * t[3] + x * (24 * t[4] + x * 60 * t[5]);
  const double d = piece.duration;
  return {u, first / d, second / (d * d), third / (d * d * d)};
}

}  // namespace

void ProcessProof::add(const JointLimits& limits, const TrajectoryPiece& piece,
                       const ToolRates& rates, double time) {
  const double speed = rates.limits.speed;
  if (time != time_) {  // a process begins here
    end();
    way_ = 0.0;
  }
  const SpeedRange range = tool_speed_range(piece.timing, piece.duration, rates.linear, speed);
  const bool held =
      range.least >= speed * (1.0 - kHeldWithin) && range.most <= speed * (1.0 + kAbove);
  double way = 0.0;
  constexpr int kParts = 16;  // Simpson's rule
  for (int k = 0; k <= kParts; ++k) {
    const Pace pace = pace_of(piece, static_cast<double>(k) / kParts);
    const double weight = k == 0 || k == kParts ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
    way += weight * rate_at(rates.linear, pace.u).value.norm() * pace.rate;
  }
  way *= piece.duration / (3.0 * kParts);
  if (held) {
    end();
  } else {
    if (open_ &&
        (stretches_.back().move != piece.move || stretches_.back().process_speed != speed)) {
      end();
    }
    if (!open_) begin(piece, speed, time);
    ProcessStretch& stretch = stretches_.back();
    stretch.to = time + piece.duration;
    stretch.to_length = way_ + way;
    stretch.lowest_speed = std::min(stretch.lowest_speed, range.reached);
    const Ruling holding = judge(limits, piece, rates);
    const bool steady = range.least >= range.most * (1.0 - kHeldWithin);
    if (steady && holding.slower <= kHoldable) unforced_ += way;
  }
  way_ += way;
  time_ = time + piece.duration;
}

void ProcessProof::begin(const TrajectoryPiece& piece, double speed, double time) {
  ProcessStretch stretch;
  stretch.move = piece.move;
  stretch.from = time;
  stretch.from_length = way_;
  stretch.process_speed = stretch.lowest_speed = speed;
  stretches_.push_back(stretch);
  open_ = true;
  rests_ = false;
  holding_ = using_ = {};
  unforced_ = 0.0;
}

void ProcessProof::end() {
  if (!open_) return;
  open_ = false;
  ProcessStretch& stretch = stretches_.back();
  const Ruling& ruling = holding_.slower > 1.0 ? holding_ : using_;
  stretch.limit = ruling.limit;
  stretch.joint = ruling.joint;
  const bool unforced = unforced_ > 0.5 * (stretch.to_length - stretch.from_length);
  if (unforced || (holding_.slower <= 1.0 && rests_)) {
    stretch.limit = unforced ? "timing" : "rest";
    stretch.joint.reset();
  }
}

Ruling ProcessProof::judge(const JointLimits& limits, const TrajectoryPiece& piece,
                           const ToolRates& rates) {
  constexpr int kParts = 8;
  Ruling holding;
  const auto look = [&](Ruling& worst, const Pace& pace, const RateAt& linear,
                        const RateAt& angular) {
    TrajectoryPiece steady = piece;
    steady.duration = 1.0;
    steady.timing = {pace.u, pace.rate, 0.5 * pace.change, pace.jerk / 6.0, 0.0, 0.0};
    worst.take(limits, rates.limits.joint_share, steady.at(0.0));
    const auto change = [&](const RateAt& w) {
      return (w.slope * pace.rate * pace.rate + w.value * pace.change).norm();
    };
    const ToolLimits& tool = rates.limits;
    worst.take(change(linear) / tool.acceleration, 2, "tool acceleration");
    worst.take(angular.value.norm() * pace.rate / tool.angular_speed, 1, "tool angular speed");
    worst.take(change(angular) / tool.angular_acceleration, 2, "tool angular acceleration");
  };
  for (int k = 0; k <= kParts; ++k) {
    const Pace pace = pace_of(piece, static_cast<double>(k) / kParts);
    const RateAt linear = rate_at(rates.linear, pace.u), angular = rate_at(rates.angular, pace.u);
    look(using_, pace, linear, angular);
    look(holding, pace_at_speed(linear, pace.u, rates.limits.speed), linear, angular);
    if ((k == 0 || k == kParts) && linear.value.norm() * pace.rate <= 1e-6 * rates.limits.speed) {
      rests_ = true;
    }
  }
  if (holding.slower > holding_.slower) holding_ = holding;
  return holding;
}

std::vector<ProcessStretch> ProcessProof::take() {
  end();
  return std::exchange(stretches_, {});
}

std::vector<ProcessStretch> ProcessProof::take_ended() {
  std::vector<ProcessStretch> ended = std::exchange(stretches_, {});
  if (open_) {
    stretches_.push_back(std::move(ended.back()));
    ended.pop_back();
  }
  return ended;
}

Problem warning_of(const ProcessStretch& stretch) {
  Problem problem;
  problem.severity = Severity::kWarning;
  problem.code = ErrorCode::kVelocityLimit;
  problem.joint = stretch.joint;
  problem.time = stretch.from;
  problem.value = stretch.lowest_speed;
  problem.limit = stretch.process_speed;
  char text[240];
  std::snprintf(text, sizeof text,
                "the process speed of %.6g m/s is not held from %.4f s to %.4f s, %.4f m to %.4f m "
                "of its way: it falls to %.4g m/s",
                stretch.process_speed, stretch.from, stretch.to, stretch.from_length,
                stretch.to_length, stretch.lowest_speed);
  problem.message = text;
  if (stretch.limit == "rest") {
    problem.message += ", as the arm starts or stops there";
    problem.ways_out = {"lead in and out by moves with a zone, so that the tool is at speed there",
                        "join the moves by corners with a zone instead of stops"};
    return problem;
  }
  if (stretch.limit == "timing") {
    problem.message +=
        ", though along most of that no limit asks for less: the timing of the whole "
        "way from stop to stop came out too slow";
    problem.ways_out = {"a process_speed that is a little lower or higher",
                        "another zone at the ends of the move, or stops"};
    return problem;
  }
  problem.message += "; what rules is the " + stretch.limit;
  if (stretch.joint) problem.message += " of joint " + std::to_string(*stretch.joint + 1);
  problem.ways_out = {"a lower process_speed", "a corner with a larger zone, or a rounder curve",
                      "another pose, in which the joints have less far to go"};
  return problem;
}

}  // namespace viapoint::planning
