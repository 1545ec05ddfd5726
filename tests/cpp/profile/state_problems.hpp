/// @file
/// Seeded problems from state to state for several joints, of the kinds that are hard: limits
/// decades apart and different in every direction, ends that a short motion just reaches or just
/// misses, starts outside the limits. The tests run the first of them, tools/bench millions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "viapoint/profile/state_to_state.hpp"

namespace viapoint::testing {

/// Splitmix64 (Steele, Lea & Flood 2014): a seed costs nothing, and the same seed gives the same
/// problem with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}

  std::uint64_t roll() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// True once in `n`.
  bool one_in(std::uint64_t n) { return roll() % n == 0; }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(roll() >> 11) * 0x1p-53);
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  double sign() { return one_in(2) ? 1.0 : -1.0; }

 private:
  std::uint64_t state_;
};

/// States and limits of all joints, and how they are to move.
struct StateProblem {
  std::vector<AxisState> start, end;
  std::vector<AxisLimits> limits;
  StateToStateOptions options;

  [[nodiscard]] std::size_t joints() const { return start.size(); }
};

/// Whether the state can be held within the limits, before and after.
inline bool is_inside(const AxisState& s, const AxisLimits& l) {
  const double slow = s.qdd * s.qdd / (2.0 * std::min(l.jerk_max, -l.jerk_min));
  return s.qdd <= l.acceleration_max && s.qdd >= l.acceleration_min &&
         s.qd + slow <= l.velocity_max && s.qd - slow >= l.velocity_min;
}

inline AxisState random_inside(Dice& dice, const AxisLimits& l) {
  for (;;) {
    AxisState s;
    if (dice.one_in(16)) return s;
    s.qd = dice.uniform(l.velocity_min, l.velocity_max);
    s.qdd = dice.uniform(l.acceleration_min, l.acceleration_max) * dice.log_uniform(1e-6, 1.0);
    if (dice.one_in(8)) s.qdd = 0.0;
    if (is_inside(s, l)) return s;
  }
}

/// Limits within `decades` to either side of one. The jerk limits are equal in half of them; else
/// they differ by a factor of 1e4 at most, beyond which the solver says it loses digits.
inline AxisLimits random_limits(Dice& dice, double decades) {
  const double least = std::pow(10.0, -decades), most = std::pow(10.0, decades);
  const auto any = [&] { return dice.log_uniform(least, most); };
  AxisLimits l;
  l.velocity_max = any();
  l.acceleration_max = any();
  l.jerk_max = any();
  l.velocity_min = -any();
  l.acceleration_min = -any();
  l.jerk_min =
      dice.one_in(2) ? -l.jerk_max : -std::clamp(any(), l.jerk_max * 1e-4, l.jerk_max * 1e4);
  return l;
}

/// One joint: somewhere else, close by, or from outside its limits.
inline void add_random_joint(Dice& dice, double decades, StateProblem& problem) {
  for (;;) {
    const AxisLimits l = random_limits(dice, decades);
    AxisState from = random_inside(dice, l), to = random_inside(dice, l);
    if (dice.one_in(2)) from.q = dice.uniform(-10.0, 10.0);
    to.q = from.q + dice.sign() * dice.log_uniform(1e-3, 1e3);
    if (dice.one_in(4)) {
      // What constant jerk reaches in a short time, or almost.
      const double t = dice.log_uniform(1e-3, 1.0);
      const double jerk = dice.one_in(4) ? (dice.one_in(2) ? l.jerk_min : l.jerk_max)
                                         : dice.uniform(l.jerk_min, l.jerk_max);
      to.qdd = from.qdd + jerk * t;
      to.qd = from.qd + t * (from.qdd + jerk * t / 2.0);
      to.q = from.q + t * (from.qd + t * (from.qdd / 2.0 + jerk * t / 6.0));
      if (!dice.one_in(3)) {
        to.q += dice.uniform(-0.1, 0.1) * dice.log_uniform(1e-6, 1.0) * jerk * t * t * t;
      }
      if (dice.one_in(5)) to.qd += 1e-15;
      if (!is_inside(to, l)) continue;
    } else if (dice.one_in(8)) {
      from.qd *= 3.0;
      from.qdd *= 3.0;
    }
    problem.start.push_back(from);
    problem.end.push_back(to);
    problem.limits.push_back(l);
    return;
  }
}

/// All states on one straight line: multiples of a direction with both signs and many lengths.
inline void put_on_line(Dice& dice, StateProblem& problem) {
  std::vector<double> direction;
  AxisLimits tightest = AxisLimits::symmetric(1e300, 1e300, 1e300);
  const auto tighten = [](double low, double high, double d, double& least, double& most) {
    least = std::max(least, std::min(low / d, high / d));
    most = std::min(most, std::max(low / d, high / d));
  };
  for (const AxisLimits& l : problem.limits) {
    const double d = dice.sign() * dice.log_uniform(1e-3, 1.0);
    direction.push_back(d);
    tighten(l.velocity_min, l.velocity_max, d, tightest.velocity_min, tightest.velocity_max);
    tighten(l.acceleration_min, l.acceleration_max, d, tightest.acceleration_min,
            tightest.acceleration_max);
    tighten(l.jerk_min, l.jerk_max, d, tightest.jerk_min, tightest.jerk_max);
  }
  const AxisState from = random_inside(dice, tightest), to = random_inside(dice, tightest);
  const double way = dice.sign() * dice.log_uniform(1e-3, 1e3);
  for (std::size_t i = 0; i < direction.size(); ++i) {
    const double d = direction[i];
    problem.start[i] = {problem.start[i].q, d * from.qd, d * from.qdd, 0.0};
    problem.end[i] = {problem.start[i].q + d * way, d * to.qd, d * to.qdd, 0.0};
  }
}

/// The problem of that seed. Most are synchronised in time, some with a cycle or a least duration;
/// the others on a line or not at all.
inline StateProblem state_problem(std::uint64_t seed, std::size_t joints, double decades) {
  Dice dice(seed);
  StateProblem problem;
  for (std::size_t i = 0; i < joints; ++i) add_random_joint(dice, decades, problem);
  switch (dice.roll() % 10) {
    case 0:
      problem.options.synchronization = Synchronization::kNone;
      break;
    case 1:
      problem.options.synchronization = Synchronization::kLine;
      put_on_line(dice, problem);
      break;
    case 2:
      problem.options.cycle = dice.one_in(2) ? 0.002 : dice.log_uniform(1e-3, 1.0);
      break;
    case 3:
      problem.options.least_duration = dice.log_uniform(1e-2, 1e3);
      break;
    default:
      break;
  }
  return problem;
}

}  // namespace viapoint::testing
