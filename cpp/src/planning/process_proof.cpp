#include "planning/process_proof.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "viapoint/trajectory/tool_certificate.hpp"

namespace viapoint::planning {
namespace {

/// Rounding of a speed that is kept as a limit.
constexpr double kAbove = 1e-9;

/// Value, slope and bend of Σ c_k u^k.
std::array<double, 3> at(const std::array<double, 6>& c, double u) {
  return {c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5])))),
          c[1] + u * (2 * c[2] + u * (3 * c[3] + u * (4 * c[4] + u * 5 * c[5]))),
          2 * c[2] + u * (6 * c[3] + u * (12 * c[4] + u * 20 * c[5]))};
}

/// A vector of the tool at u: its square with two derivatives, and its acceleration's parts.
struct RateAt {
  Eigen::Vector3d value, slope, bend;
};

RateAt rate_at(const ToolRate& rate, double u) {
  RateAt result;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [value, slope, bend] = at(rate.coefficients[static_cast<size_t>(axis)], u);
    result.value[axis] = value;
    result.slope[axis] = slope;
    result.bend[axis] = bend;
  }
  return result;
}

/// u and its derivatives by time.
struct Pace {
  double u = 0.0, rate = 0.0, change = 0.0, jerk = 0.0;
};

Pace pace_of(const TrajectoryPiece& piece, double x) {
  const auto [u, first, second] = at(piece.timing, x);
  const auto& t = piece.timing;
  const double third = 6 * t[3] + x * (24 * t[4] + x * 60 * t[5]);
  const double d = piece.duration;
  return {u, first / d, second / (d * d), third / (d * d * d)};
}

/// The pace at u that keeps the tool's speed: u̇² = v² / f with f = ‖p_u‖², so ü = -v² f' / 2f² and
/// u⃛ = u̇ dü/du.
Pace pace_at_speed(const RateAt& w, double u, double speed) {
  const double f = w.value.squaredNorm();
  if (!(f > 0.0)) return {u, 0.0, 0.0, 0.0};
  const double f1 = 2.0 * w.value.dot(w.slope);
  const double f2 = 2.0 * (w.slope.squaredNorm() + w.value.dot(w.bend));
  const double v2 = speed * speed, rate = speed / std::sqrt(f);
  return {u, rate, -0.5 * v2 * f1 / (f * f),
          rate * -0.5 * v2 * (f2 / (f * f) - 2.0 * f1 * f1 / (f * f * f))};
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
    judge(limits, piece, rates);
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
}

void ProcessProof::end() {
  if (!open_) return;
  open_ = false;
  ProcessStretch& stretch = stretches_.back();
  const Ruling& ruling = holding_.share > 1.0 ? holding_ : using_;
  stretch.limit = ruling.limit;
  stretch.joint = ruling.joint;
  if (holding_.share <= 1.0 && rests_) {
    stretch.limit = "rest";
    stretch.joint.reset();
  }
}

void ProcessProof::judge(const JointLimits& limits, const TrajectoryPiece& piece,
                         const ToolRates& rates) {
  constexpr int kParts = 8;
  const auto look = [&](Ruling& worst, const Pace& pace, const RateAt& linear,
                        const RateAt& angular) {
    // Compared by how much slower they want it.
    const auto take = [&](double share, double root, const char* name, std::optional<int> joint) {
      const double slower = std::pow(share, root);
      if (slower > worst.share) worst = {slower, name, joint};
    };
    TrajectoryPiece steady = piece;
    steady.duration = 1.0;
    steady.timing = {pace.u, pace.rate, 0.5 * pace.change, pace.jerk / 6.0, 0.0, 0.0};
    const JointState state = steady.at(0.0);
    for (int i = 0; i < limits.joints(); ++i) {
      take(std::abs(state.qd[i]) / limits.velocity[i], 1.0, "velocity", i);
      take(std::abs(state.qdd[i]) / limits.acceleration[i], 1.0 / 2.0, "acceleration", i);
      take(std::abs(state.qddd[i]) / limits.jerk[i], 1.0 / 3.0, "jerk", i);
    }
    const auto change = [&](const RateAt& w) {
      return (w.slope * pace.rate * pace.rate + w.value * pace.change).norm();
    };
    const ToolLimits& tool = rates.limits;
    take(change(linear) / tool.acceleration, 0.5, "tool acceleration", std::nullopt);
    take(angular.value.norm() * pace.rate / tool.angular_speed, 1.0, "tool angular speed",
         std::nullopt);
    take(change(angular) / tool.angular_acceleration, 0.5, "tool angular acceleration",
         std::nullopt);
  };
  for (int k = 0; k <= kParts; ++k) {
    const Pace pace = pace_of(piece, static_cast<double>(k) / kParts);
    const RateAt linear = rate_at(rates.linear, pace.u), angular = rate_at(rates.angular, pace.u);
    look(using_, pace, linear, angular);
    look(holding_, pace_at_speed(linear, pace.u, rates.limits.speed), linear, angular);
    if ((k == 0 || k == kParts) && linear.value.norm() * pace.rate <= 1e-6 * rates.limits.speed) {
      rests_ = true;
    }
  }
}

std::vector<ProcessStretch> ProcessProof::take() {
  end();
  return std::move(stretches_);
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
  problem.message += "; what rules is the " + stretch.limit;
  if (stretch.joint) problem.message += " of joint " + std::to_string(*stretch.joint + 1);
  problem.ways_out = {"a lower process_speed", "a corner with a larger zone, or a rounder curve",
                      "another pose, in which the joints have less far to go"};
  return problem;
}

}  // namespace viapoint::planning
