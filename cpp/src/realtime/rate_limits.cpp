#include "viapoint/realtime/rate_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viapoint {
namespace {

/// Relative slack of the limits for rounding, as small as that of the planner.
constexpr double kRounding = 1e-9;
/// Stands for 0 where a quotient by it is to be beyond any curvature there is.
constexpr double kNothing = 1e-100;

using Eigen::Array2d;

Range product(const Range& a, const Range& b) noexcept {
  const double p1 = a.low * b.low, p2 = a.low * b.high, p3 = a.high * b.low, p4 = a.high * b.high;
  return {std::min({p1, p2, p3, p4}), std::max({p1, p2, p3, p4})};
}

// Inlined always, for the pairs to stay in registers: the compiler thinks them too large.

/// Times a factor of which neither end is negative.
[[gnu::always_inline]] inline PairRange scaled(const PairRange& x, const Range& factor) noexcept {
  return {(x.low * factor.low).min(x.low * factor.high),
          (x.high * factor.low).max(x.high * factor.high)};
}

[[gnu::always_inline]] inline PairRange product(const PairRange& x, const Range& factor) noexcept {
  const Array2d a = x.low * factor.low, b = x.low * factor.high;
  const Array2d c = x.high * factor.low, d = x.high * factor.high;
  return {a.min(b).min(c.min(d)), a.max(b).max(c.max(d))};
}

[[gnu::always_inline]] inline PairRange product(const PairRange& x, double factor) noexcept {
  const Array2d a = x.low * factor, b = x.high * factor;
  return {a.min(b), a.max(b)};
}

[[gnu::always_inline]] inline PairRange sum(const PairRange& a, const PairRange& b) noexcept {
  return {a.low + b.low, a.high + b.high};
}

/// 1 in the lanes whose range is within ±limit, 0 in the others: also where an end is not a number,
/// which no comparison holds for (min and max would drop it).
[[gnu::always_inline]] inline Array2d is_within(const PairRange& x, const Array2d& limit) noexcept {
  const Array2d most = (1.0 + kRounding) * limit;
  return (x.high <= most && -x.low <= most).cast<double>();
}

/// 0 where every end is finite, not a number elsewhere.
[[gnu::always_inline]] inline Array2d doubt_of(const PairRange& a, const PairRange& b,
                                               const PairRange& c) noexcept {
  return 0.0 * (a.low + a.high + b.low + b.high + c.low + c.high);
}
double doubt_of(const Range& x) noexcept { return 0.0 * (x.low + x.high); }

/// What is left of a limit for `factor` times γ: -below <= factor γ <= above.
struct Room {
  Array2d below, above;
};

/// Half the slack, so that the strongest γ passes kept() in spite of rounding.
[[gnu::always_inline]] inline Room room_beside(const PairRange& used,
                                               const Array2d& limit) noexcept {
  const Array2d most = (1.0 + 0.5 * kRounding) * limit;
  return {most + used.low, most - used.high};
}

[[gnu::always_inline]] inline bool is_none(const Room& room) noexcept {
  return !(room.below >= 0.0 && room.above >= 0.0).all();
}

/// q̈ where the stretch begins.
[[gnu::always_inline]] inline PairRange first_acceleration(const RateStretch& stretch,
                                                           std::size_t p) noexcept {
  return sum(product(stretch.path.second_there.pair[p], stretch.first_rate * stretch.first_rate),
             product(stretch.path.first_there.pair[p], stretch.first_slope));
}

/// What the joints have taken of their limits before a push, and what the push uses up.
struct Demand {
  Room start;                  ///< what q̈ leaves where the stretch begins
  Room acceleration, jerk;     ///< what is left for γt q' at its end, and for γ times the next two
  Room drift;                  ///< what is left of the jerk, for q̈ to stay within its limits
  PairRange at_start, at_end;  ///< q' and q' + 3q''ρt
};

[[gnu::always_inline]] inline Demand demand_of(const RateStretch& stretch, std::size_t p,
                                               const Array2d& most_acceleration,
                                               const Array2d& most_jerk) noexcept {
  const PairRange& first = stretch.path.ranges.first.pair[p];
  const PairRange& second = stretch.path.ranges.second.pair[p];
  const PairRange& third = stretch.path.ranges.third.pair[p];
  const Range& rate = stretch.rate;
  const Range square{rate.low * rate.low, rate.high * rate.high};
  const Range cube{square.low * rate.low, square.high * rate.high};
  const PairRange mixed = scaled(second, {3.0 * rate.low, 3.0 * rate.high});
  const PairRange jerk = sum(scaled(third, cube), product(mixed, stretch.first_slope));
  const double per_time = 1.0 / stretch.time;
  Demand demand;
  demand.start = room_beside(first_acceleration(stretch, p), most_acceleration);
  demand.start.above += doubt_of(first, second, third);
  demand.acceleration = room_beside(
      sum(scaled(second, square), product(first, stretch.first_slope)), most_acceleration);
  demand.jerk = room_beside(jerk, most_jerk);
  demand.drift = {demand.start.below * per_time + jerk.low,
                  demand.start.above * per_time - jerk.high};
  demand.at_start = first;
  demand.at_end = sum(first, scaled(mixed, {stretch.time, stretch.time}));
  return demand;
}

/// The largest γ of a sign that fits into the room, where it takes up so much a unit.
[[gnu::always_inline]] inline Array2d most_in(const Room& room, const Array2d& toward,
                                              const Array2d& away) noexcept {
  return (room.above / toward).min(room.below / away);
}

/// The γ that are left where 0 is not among them.
class ForcedRange {
 public:
  /// Narrows to where -below <= f γ <= above for every f in [low, high].
  void narrow(double low, double high, double below, double above) noexcept {
    narrow(low, high, above);
    narrow(-high, -low, below);
  }
  /// Brings γ into the range; false where that is empty, or not a number.
  [[nodiscard]] bool take(double& curvature) const noexcept {
    if (!(low_ <= high_)) return false;
    curvature = std::clamp(curvature, low_, high_);
    return true;
  }

 private:
  /// To where f γ <= most for every f in [low, high].
  void narrow(double low, double high, double most) noexcept {
    if (most >= 0.0) {
      high_ = std::min(high_, most / std::max(high, kNothing));
      low_ = std::max(low_, most / std::min(low, -kNothing));
    } else if (low > 0.0) {
      high_ = std::min(high_, most / low);
    } else if (high < 0.0) {
      low_ = std::max(low_, most / high);
    } else {
      low_ = std::numeric_limits<double>::infinity();
    }
  }

  double low_ = -std::numeric_limits<double>::infinity();
  double high_ = std::numeric_limits<double>::infinity();
};

}  // namespace

RateLimits::RateLimits(const JointLimits& limits)
    : pairs_(static_cast<std::size_t>((limits.joints() + 1) / 2)) {
  constexpr double kNoLimit = 1e300;
  limits_.fill({Array2d::Constant(kNoLimit), Array2d::Constant(kNoLimit)});
  for (int j = 0; j < limits.joints(); ++j) {
    PairLimits& pair = limits_[static_cast<std::size_t>(j / 2)];
    pair.acceleration[j % 2] = limits.acceleration[j];
    pair.jerk[j % 2] = limits.jerk[j];
  }
}

bool RateLimits::kept(const RateStretch& stretch) const noexcept VIAPOINT_NONBLOCKING {
  const Range& rate = stretch.rate;
  const Range square{rate.low * rate.low, rate.high * rate.high};
  const Range cube{square.low * rate.low, square.high * rate.high};
  const Range mixed = product(rate, {3.0 * stretch.slope.low, 3.0 * stretch.slope.high});
  const double doubt = doubt_of(rate) + doubt_of(stretch.slope) + 0.0 * stretch.curvature;
  Array2d is_kept = Array2d::Constant(1.0 + doubt);
  for (std::size_t p = 0; p < pairs_; ++p) {
    const PairRange& first = stretch.path.ranges.first.pair[p];
    const PairRange& second = stretch.path.ranges.second.pair[p];
    const PairRange& third = stretch.path.ranges.third.pair[p];
    const PairRange acceleration = sum(scaled(second, square), product(first, stretch.slope));
    const PairRange jerk =
        sum(scaled(third, cube), sum(product(second, mixed), product(first, stretch.curvature)));
    const PairRange start = first_acceleration(stretch, p);
    const PairRange reached{start.low + stretch.time * jerk.low.min(0.0),
                            start.high + stretch.time * jerk.high.max(0.0)};
    const Array2d& most = limits_[p].acceleration;
    is_kept *= is_within(acceleration, most).max(is_within(reached, most)) *
               is_within(jerk, limits_[p].jerk);
    is_kept += doubt_of(first, second, third);
  }
  return is_kept[0] == 1.0 && is_kept[1] == 1.0;
}

// q̈ = q''ρ² + q'(α + γt) and q⃛ = q'''ρ³ + 3q''ρ(α + γt) + q'γ are linear in γ, and in t: their
// worst is at the start or the end.

bool RateLimits::strongest(const RateStretch& stretch,
                           double& curvature) const noexcept VIAPOINT_NONBLOCKING {
  const bool is_positive = curvature >= 0.0;
  if (std::isnan(doubt_of(stretch.rate) + 0.0 * stretch.first_slope + 0.0 * curvature)) {
    return false;
  }
  const Array2d nothing = Array2d::Constant(kNothing);
  Array2d most = Array2d::Constant(std::abs(curvature));
  for (std::size_t p = 0; p < pairs_; ++p) {
    const Demand demand = demand_of(stretch, p, limits_[p].acceleration, limits_[p].jerk);
    if (is_none(demand.start)) return false;  // where no γ helps
    // How fast γ uses up what is left in its direction, and in the other.
    const Array2d up = demand.at_start.high.max(nothing);
    const Array2d down = (-demand.at_start.low).max(nothing);
    const Array2d up_all = up.max(demand.at_end.high), down_all = down.max(-demand.at_end.low);
    const Array2d &toward = is_positive ? up : down, &away = is_positive ? down : up;
    const Array2d& toward_all = is_positive ? up_all : down_all;
    const Array2d& away_all = is_positive ? down_all : up_all;
    const Array2d by_end = most_in(demand.acceleration, toward, away) / stretch.time;
    const Array2d by_drift = most_in(demand.drift, toward_all, away_all);
    const Array2d by_jerk = most_in(demand.jerk, toward_all, away_all);
    most = most.min(by_jerk).min(by_end.max(by_drift));
    if (!(most >= 0.0).all()) return forced(stretch, curvature);
  }
  curvature = is_positive ? most.minCoeff() : -most.minCoeff();
  return true;
}

/// The same where a joint has to be pushed.
bool RateLimits::forced(const RateStretch& stretch,
                        double& curvature) const noexcept VIAPOINT_NONBLOCKING {
  ForcedRange range;
  const double time = stretch.time;
  for (std::size_t p = 0; p < pairs_; ++p) {
    const Demand demand = demand_of(stretch, p, limits_[p].acceleration, limits_[p].jerk);
    if (is_none(demand.start)) return false;
    const PairRange &first = demand.at_start, &last = demand.at_end;
    for (int lane = 0; lane < 2; ++lane) {
      double below = demand.jerk.below[lane], above = demand.jerk.above[lane];
      if (demand.acceleration.below[lane] >= 0.0 && demand.acceleration.above[lane] >= 0.0) {
        range.narrow(time * first.low[lane], time * first.high[lane],
                     demand.acceleration.below[lane], demand.acceleration.above[lane]);
      } else {
        below = std::min(below, demand.drift.below[lane]);
        above = std::min(above, demand.drift.above[lane]);
      }
      range.narrow(first.low[lane], first.high[lane], below, above);
      range.narrow(last.low[lane], last.high[lane], below, above);
    }
  }
  return range.take(curvature);
}

}  // namespace viapoint
