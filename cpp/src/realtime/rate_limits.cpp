#include "viapoint/realtime/rate_limits.hpp"

#include <algorithm>

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
[[gnu::always_inline]] inline Array2d doubt_of(const PairRange& x) noexcept {
  return 0.0 * x.low + 0.0 * x.high;
}
double doubt_of(const Range& x) noexcept { return 0.0 * x.low + 0.0 * x.high; }

/// What a limit leaves for `factor` times γ: -below <= factor γ <= above.
struct Demand {
  PairRange factor;
  Array2d below, above;
};

/// `used` is what has been taken of the limit already. Half the slack, so that the strongest push
/// passes kept() in spite of rounding.
[[gnu::always_inline]] inline Demand demand_of(const PairRange& factor, const Array2d& limit,
                                               const PairRange& used) noexcept {
  const Array2d most = (1.0 + 0.5 * kRounding) * limit;
  return {factor, most + used.low, most - used.high};
}

/// The γ that meet every demand so far.
class Allowed {
 public:
  explicit Allowed(const Range& range) noexcept
      : low_(Array2d::Constant(range.low)), high_(Array2d::Constant(range.high)) {}

  [[gnu::always_inline]] inline void narrow(const Demand& demand) noexcept {
    if ((demand.below.min(demand.above) < 0.0).any()) {
      for (int lane = 0; lane < 2; ++lane) narrow(demand, lane);
      return;
    }
    const Array2d up = demand.factor.high.max(kNothing);
    const Array2d down = (-demand.factor.low).max(kNothing);
    high_ = high_.min((demand.above / up).min(demand.below / down));
    low_ = low_.max(-(demand.above / down).min(demand.below / up));
  }
  [[nodiscard]] Range range() const noexcept {
    if (!possible_) return {1.0, -1.0};
    return {low_.maxCoeff(), high_.minCoeff()};
  }

 private:
  /// For the joint that has to be pushed: 0 is not allowed.
  void narrow(const Demand& demand, int lane) noexcept {
    const double low = demand.factor.low[lane], high = demand.factor.high[lane];
    narrow(low, high, demand.above[lane]);
    narrow(-high, -low, demand.below[lane]);
  }
  /// To where f γ <= most for every f in [low, high].
  void narrow(double low, double high, double most) noexcept {
    if (most >= 0.0) {
      high_ = high_.min(most / std::max(high, kNothing));
      low_ = low_.max(most / std::min(low, -kNothing));
    } else if (low > 0.0) {
      high_ = high_.min(most / low);
    } else if (high < 0.0) {
      low_ = low_.max(most / high);
    } else {
      possible_ = false;
    }
  }

  Array2d low_, high_;
  bool possible_ = true;
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
    const PairRange& first = stretch.path.first.pair[p];
    const PairRange& second = stretch.path.second.pair[p];
    const PairRange& third = stretch.path.third.pair[p];
    const PairRange acceleration = sum(scaled(second, square), product(first, stretch.slope));
    const PairRange jerk =
        sum(scaled(third, cube), sum(product(second, mixed), product(first, stretch.curvature)));
    is_kept *= is_within(acceleration, limits_[p].acceleration) * is_within(jerk, limits_[p].jerk);
    is_kept += doubt_of(first) + doubt_of(second) + doubt_of(third);
  }
  return is_kept[0] == 1.0 && is_kept[1] == 1.0;
}

bool RateLimits::room(const RateStretch& stretch, double time,
                      Range& curvature) const noexcept VIAPOINT_NONBLOCKING {
  // q̈ = q''ρ² + q'(α + γt) and
  // q⃛ = q'''ρ³ + 3q''ρ(α + γt) + q'γ are linear in γ; their worst is at the start or the end.
  const Range& rate = stretch.rate;
  const Range square{rate.low * rate.low, rate.high * rate.high};
  const Range cube{square.low * rate.low, square.high * rate.high};
  const Range thrice{3.0 * rate.low, 3.0 * rate.high};
  const double slope = stretch.slope.low;
  Allowed allowed(curvature);
  for (std::size_t p = 0; p < pairs_; ++p) {
    const PairRange& first = stretch.path.first.pair[p];
    const PairRange& second = stretch.path.second.pair[p];
    const PairRange gain = scaled(first, {time, time});
    allowed.narrow(demand_of(gain, limits_[p].acceleration,
                             sum(scaled(second, square), product(first, slope))));
    const PairRange mixed = scaled(second, thrice);
    Demand demand = demand_of(first, limits_[p].jerk,
                              sum(scaled(stretch.path.third.pair[p], cube), product(mixed, slope)));
    allowed.narrow(demand);
    demand.factor = sum(first, scaled(mixed, {time, time}));
    allowed.narrow(demand);
  }
  curvature = allowed.range();
  return curvature.low <= curvature.high;
}

}  // namespace viapoint
