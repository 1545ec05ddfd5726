#include "state_soundness.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint::python {
namespace {

/// Share of a motion's size, and of a limit.
constexpr double kSlack = 1e-8;
/// Share of a sum of two doubles that rounding takes, with room for a few such sums.
constexpr double kRounding = 1e-15;

class Range {
 public:
  /// A value is as coarse as the farther of the two limits is large.
  Range(double low, double high)
      : low_(low + kSlack * low - kRounding * (high - low)),
        high_(high + kSlack * high + kRounding * (high - low)) {}
  [[nodiscard]] bool holds(double value) const { return value >= low_ && value <= high_; }

 private:
  double low_, high_;
};

}  // namespace

// Rates are held against what they may be, not against what they are: a short motion far from zero
// moves by few of its position's last digits, and its velocities are no better. And a duration has
// last digits, too: a joint that waits long for another cannot time its own short phases any finer
// than that, nor the rates that change in them.
// Gaps are summed, and every comparison is written, so that NaN fails.
bool is_sound(const AxisMove& move, const AxisState& start, const AxisLimits& l) {
  const Range velocity(l.velocity_min, l.velocity_max);
  const Range acceleration(l.acceleration_min, l.acceleration_max);
  const Range jerk(l.jerk_min, l.jerk_max);
  const double least_jerk = std::min(l.jerk_max, -l.jerk_min);
  const double speed = std::max({l.velocity_max, -l.velocity_min, std::abs(start.qd)});
  const double push = std::max({l.acceleration_max, -l.acceleration_min, std::abs(start.qdd)});
  const double clock = kRounding * move.total;
  double size = std::abs(move.end.q - start.q) + 1e-6 * std::abs(start.q);
  const AxisState& first = move.phases > 0 ? move.phase[0].from : move.end;
  double way_gap = std::abs(first.q - start.q), speed_gap = std::abs(first.qd - start.qd),
         push_gap = std::abs(first.qdd - start.qdd);
  bool inside = false;
  for (int i = 0; i < move.phases; ++i) {
    const auto& [t, from] = move.phase[static_cast<size_t>(i)];
    const AxisState& next =
        i + 1 < move.phases ? move.phase[static_cast<size_t>(i) + 1].from : move.end;
    const double push_change = t * from.qddd;
    const double speed_change = t * (from.qdd + 0.5 * push_change);
    const double way = t * (from.qd + t * (0.5 * from.qdd + push_change / 6.0));
    size = std::max({size, std::abs(from.q - start.q), std::abs(way)});
    way_gap += std::abs(from.q + way - next.q);
    speed_gap += std::abs(from.qd + speed_change - next.qd);
    push_gap += std::abs(from.qdd + push_change - next.qdd);

    if (!jerk.holds(from.qddd)) return false;
    const double slow = 0.5 * from.qdd * from.qdd / least_jerk;
    inside = inside || (velocity.holds(from.qd + slow) && velocity.holds(from.qd - slow) &&
                        acceleration.holds(from.qdd));
    if (!inside) continue;
    if (!velocity.holds(from.qd) || !acceleration.holds(from.qdd)) return false;
    // Where the acceleration vanishes within the phase, the velocity is extreme.
    const double end_push = from.qdd + push_change;
    if (from.qdd * end_push < 0.0 &&
        !velocity.holds(from.qd - 0.5 * from.qdd * from.qdd / from.qddd)) {
      return false;
    }
  }
  const double most_jerk = std::max(l.jerk_max, -l.jerk_min);
  return way_gap <= kSlack * size && speed_gap <= kSlack * speed + clock * push &&
         push_gap <= kSlack * push + clock * most_jerk && std::isfinite(size) &&
         std::isfinite(move.total);
}

}  // namespace viapoint::python
