#include "viapoint/profile/jerk_profile.hpp"

#include <algorithm>
#include <cmath>

#include "profile/constant_jerk.hpp"

namespace viapoint {
namespace {

/// Durations of a symmetric rest-to-rest move: jerk, constant acceleration, constant velocity.
struct RampTimes {
  double jerk = 0.0, acceleration = 0.0, velocity = 0.0;
};

/// Unit distance and unit jerk. A ramp to speed V and back covers V (2 t_jerk + t_acceleration), so
/// the quickest move is the first of three that fits (Biagiotti & Melchiorri 2008, §3.4): to V = v
/// and cruise; to the V < v that an acceleration of `a` reaches half way; jerk alone.
RampTimes unit_times(double v, double a) {
  RampTimes times;
  const bool reaches_a = a * a < v;
  times.jerk = reaches_a ? a : std::sqrt(v);
  times.acceleration = reaches_a ? v / a - a : 0.0;
  const double ramps = v * (2.0 * times.jerk + times.acceleration);
  if (ramps <= 1.0) {
    times.velocity = (1.0 - ramps) / v;
    return times;
  }
  if (2.0 * a * a * a < 1.0) {
    // V (V/a + a) = 1; the root written so that nothing cancels.
    const double peak = 2.0 * a / (a * a + std::sqrt(a * a * a * a + 4.0 * a));
    return {a, std::max(0.0, peak / a - a), 0.0};
  }
  return {std::cbrt(0.5), 0.0, 0.0};
}

}  // namespace

double JerkProfile::total() const {
  double sum = 0.0;
  for (int i = 0; i < phases; ++i) sum += duration[static_cast<size_t>(i)];
  return sum;
}

AxisState JerkProfile::at(double t) const {
  AxisState state = start;
  if (!(t > 0.0)) t = 0.0;
  // The end is reached phase by phase: what is left of t after long phases has lost its last bits.
  const bool ended = t >= total();
  for (int i = 0; i < phases; ++i) {
    const auto phase = static_cast<size_t>(i);
    if (!ended && (i + 1 == phases || t < duration[phase])) {
      return advanced(state, jerk[phase], std::min(t, duration[phase]));
    }
    state = advanced(state, jerk[phase], duration[phase]);
    t -= duration[phase];
  }
  return state;
}

JerkProfile rest_to_rest(double distance, double velocity, double acceleration, double jerk) {
  JerkProfile profile;
  const double length = std::abs(distance);
  if (!(length > 0.0)) return profile;
  // With lengths counted in `length` and times in (length/jerk)^⅓, distance and jerk are one, and
  // what is left is of the order of one whatever the units are. Roots first: no under- or overflow.
  const double root_length = std::cbrt(length);
  const double root_jerk = std::cbrt(jerk);
  const double unit = root_length / root_jerk;
  const double v = velocity / root_jerk / root_length / root_length;
  const double a = acceleration / root_jerk / root_jerk / root_length;
  const RampTimes times = unit_times(v, a);

  const double j = std::copysign(jerk, distance);
  const std::array<double, 7> durations{times.jerk, times.acceleration, times.jerk, times.velocity,
                                        times.jerk, times.acceleration, times.jerk};
  const std::array<double, 7> jerks{j, 0.0, -j, 0.0, -j, 0.0, j};
  for (size_t i = 0; i < durations.size(); ++i) {
    if (!(durations[i] > 0.0)) continue;
    profile.duration[static_cast<size_t>(profile.phases)] = durations[i] * unit;
    profile.jerk[static_cast<size_t>(profile.phases)] = jerks[i];
    ++profile.phases;
  }
  return profile;
}

}  // namespace viapoint
