#include "profile/touch.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint {
namespace {

/// Regula falsi takes ten steps or so; bisection alone would need as many.
constexpr int kMostSteps = 60;
/// Share of the interval at which a root is known well enough.
constexpr double kConverged = 1e-15;

/// Where the quickest change to rest with acceleration `touch` ends.
double reach(const AxisState& s, const AxisLimits& limits, double touch) noexcept {
  AxisMove move;
  const MoveStatus status = quickest_velocity_change(s, {0.0, 0.0, touch, 0.0}, limits, move);
  return status == MoveStatus::kSolved ? move.end.q : HUGE_VAL;
}

/// The acceleration at which the velocity gets to zero under the hardest braking that the velocity
/// limit on the way back allows.
double braked(const AxisState& s, const AxisLimits& l) noexcept {
  const double squared = std::max(0.0, s.qdd * s.qdd - 2.0 * l.jerk_min * s.qd);
  return std::max(-std::sqrt(squared), hardest_touch(l));
}

/// The touch between `inside`, which stops short of the wall or at it, and `beyond` that ends at
/// the wall: the last known to stop short of it. (Illinois method, Dowell & Jarratt 1971.)
double touch_at(const AxisState& s, const AxisLimits& limits, double wall, double inside,
                double beyond) noexcept {
  const double width = std::abs(beyond - inside);
  double short_by = reach(s, limits, inside) - wall, over_by = reach(s, limits, beyond) - wall;
  int kept = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    if (short_by == 0.0 || std::abs(beyond - inside) <= kConverged * width) break;
    double next = inside + (beyond - inside) * (short_by / (short_by - over_by));
    if (!(next > std::min(inside, beyond) && next < std::max(inside, beyond))) {
      next = 0.5 * (inside + beyond);
      if (next == inside || next == beyond) break;
    }
    const double off = reach(s, limits, next) - wall;
    if (off <= 0.0) {
      inside = next;
      short_by = off;
      if (kept == 1) over_by *= 0.5;
      kept = 1;
    } else {
      beyond = next;
      over_by = off;
      if (kept == -1) short_by *= 0.5;
      kept = -1;
    }
  }
  return inside;
}

}  // namespace

bool approaches(const AxisState& s, const AxisLimits& l) noexcept {
  return s.qd > 0.0 || (s.qdd > 0.0 && s.qdd * s.qdd - 2.0 * l.jerk_min * s.qd > 0.0);
}

double least_peak(const AxisState& s, const AxisLimits& limits) noexcept {
  return std::max(s.q, reach(s, limits, braked(s, limits)));
}

double hardest_touch(const AxisLimits& l) noexcept {
  const double before = std::sqrt(-2.0 * l.jerk_min * l.velocity_max);
  const double after = std::sqrt(-2.0 * l.jerk_max * l.velocity_min);
  return -std::min({before, after, -l.acceleration_min});
}

TouchRange touch_range(const AxisState& s, const AxisLimits& limits, double wall) noexcept {
  const double hardest = hardest_touch(limits), middle = braked(s, limits);
  TouchRange range{hardest, 0.0, false, reach(s, limits, middle) <= wall};
  if (!range.possible) {
    range.hardest = range.gentlest = middle;
    range.forced = true;
    return range;
  }
  // Already braking too hard to stop there, it turns around with no less than this.
  const double turn = std::max(0.0, s.qdd * s.qdd - 2.0 * limits.jerk_max * s.qd);
  const double gentlest = s.qdd < 0.0 ? std::max(middle, -std::sqrt(turn)) : 0.0;
  if (reach(s, limits, gentlest) > wall) {
    range.forced = true;
    range.gentlest = touch_at(s, limits, wall, middle, gentlest);
  }
  if (middle > hardest && reach(s, limits, hardest) > wall) {
    range.hardest = touch_at(s, limits, wall, middle, hardest);
  }
  return range;
}

}  // namespace viapoint
