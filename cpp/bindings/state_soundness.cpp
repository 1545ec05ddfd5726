#include "state_soundness.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint::python {
namespace {

/// Share of a motion's size, and of the range between two limits.
constexpr double kSlack = 1e-8;

class Range {
 public:
  Range(double low, double high)
      : low_(low - kSlack * (high - low)), high_(high + kSlack * (high - low)) {}
  [[nodiscard]] bool holds(double value) const { return value >= low_ && value <= high_; }

 private:
  double low_, high_;
};

}  // namespace

// Every comparison is written so that NaN fails.
bool is_sound(const AxisMove& move, const AxisState& start, const AxisLimits& l) {
  const Range velocity(l.velocity_min, l.velocity_max);
  const Range acceleration(l.acceleration_min, l.acceleration_max);
  const double least_jerk = std::min(l.jerk_max, -l.jerk_min);
  double size = std::abs(move.end.q - start.q) + 1e-6 * std::abs(start.q);
  double speed = std::abs(move.end.qd), push = std::abs(move.end.qdd);
  double way_gap = 0.0, speed_gap = 0.0, push_gap = 0.0;
  bool inside = false;
  for (int i = 0; i < move.phases; ++i) {
    const auto& [t, from] = move.phase[static_cast<size_t>(i)];
    const AxisState& next =
        i + 1 < move.phases ? move.phase[static_cast<size_t>(i) + 1].from : move.end;
    const double push_change = t * from.qddd;
    const double speed_change = t * (from.qdd + 0.5 * push_change);
    const double way = t * (from.qd + t * (0.5 * from.qdd + push_change / 6.0));
    size = std::max({size, std::abs(from.q - start.q), std::abs(way)});
    speed = std::max({speed, std::abs(from.qd), std::abs(speed_change)});
    push = std::max({push, std::abs(from.qdd), std::abs(push_change)});
    way_gap = std::max(way_gap, std::abs(from.q + way - next.q));
    speed_gap = std::max(speed_gap, std::abs(from.qd + speed_change - next.qd));
    push_gap = std::max(push_gap, std::abs(from.qdd + push_change - next.qdd));

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
  return way_gap <= kSlack * size && speed_gap <= kSlack * speed && push_gap <= kSlack * push &&
         std::isfinite(size) && std::isfinite(move.total);
}

}  // namespace viapoint::python
