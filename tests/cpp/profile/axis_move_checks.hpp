/// @file
/// Random problems from state to state, and what must hold of their solutions, worked out anew with
/// more digits than the solver has.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "viapoint/profile/axis_move.hpp"

namespace viapoint::testing {

struct AxisRequest {
  AxisState start, end;
  AxisLimits limits;
};

inline double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline double log_uniform(std::mt19937_64& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

/// A state that can be held within the limits before and after.
inline AxisState random_state(std::mt19937_64& random, const AxisLimits& l) {
  for (;;) {
    AxisState s{
        0.0, uniform(random, l.velocity_min, l.velocity_max),
        uniform(random, l.acceleration_min, l.acceleration_max) * log_uniform(random, 1e-6, 1.0),
        0.0};
    if (random() % 8 == 0) s.qdd = 0.0;
    if (random() % 16 == 0) s.qd = s.qdd = 0.0;
    const double slow = s.qdd * s.qdd / 2.0;
    const double above = s.qd + slow / std::min(l.jerk_max, -l.jerk_min);
    const double below = s.qd - slow / std::min(l.jerk_max, -l.jerk_min);
    if (above <= l.velocity_max && below >= l.velocity_min) return s;
  }
}

/// Limits within `decades` to either side of one; different in every direction.
inline AxisRequest random_request(std::mt19937_64& random, double decades) {
  const double least = std::pow(10.0, -decades), most = std::pow(10.0, decades);
  const auto any = [&] { return log_uniform(random, least, most); };
  AxisRequest r;
  r.limits = {-any(), any(), -any(), any(), -any(), any()};
  r.start = random_state(random, r.limits);
  r.end = random_state(random, r.limits);
  r.start.q = uniform(random, -1.0, 1.0);
  r.end.q = r.start.q + any() * (random() % 2 == 0 ? 1.0 : -1.0);
  return r;
}

/// An end that a short motion from the start at constant jerk reaches, just misses, or reaches but
/// for rounding; with the jerk at its limit it is the only motion that short. There the durations
/// have gaps.
inline AxisRequest random_short_request(std::mt19937_64& random) {
  for (;;) {
    AxisRequest r = random_request(random, 0.7);
    const double t = log_uniform(random, 1e-3, 1.0);
    double j = uniform(random, r.limits.jerk_min, r.limits.jerk_max);
    if (random() % 4 == 0) j = random() % 2 == 0 ? r.limits.jerk_min : r.limits.jerk_max;
    r.end.qdd = r.start.qdd + j * t;
    r.end.qd = r.start.qd + t * (r.start.qdd + j * t / 2.0);
    r.end.q = r.start.q + t * (r.start.qd + t * (r.start.qdd / 2.0 + j * t / 6.0));
    if (random() % 3 != 0) {
      const double share = uniform(random, -0.1, 0.1) * log_uniform(random, 1e-6, 1.0);
      r.end.q += share * std::abs(j) * t * t * t;
    }
    if (random() % 5 == 0) r.end.qd += 1e-15;
    AxisMove probe;
    if (quickest_move(r.start, r.end, r.limits, probe) == MoveStatus::kSolved) return r;
  }
}

inline double scale_of(double low, double high) { return std::max(-low, high); }

/// The phases follow one another from start to end, and no jerk is over its limit.
inline void expect_connected(const AxisRequest& r, const AxisMove& move) {
  ASSERT_TRUE(std::isfinite(move.total));
  ASSERT_LE(move.phases, AxisMove::kMaxPhases);
  EXPECT_EQ(move.end.q, r.end.q);
  EXPECT_EQ(move.end.qd, r.end.qd);
  EXPECT_EQ(move.end.qdd, r.end.qdd);
  if (move.phases > 0) {
    EXPECT_EQ(move.phase[0].from.q, r.start.q);
    EXPECT_EQ(move.phase[0].from.qd, r.start.qd);
    EXPECT_EQ(move.phase[0].from.qdd, r.start.qdd);
  }
  long double total = 0.0L, size = std::abs(r.end.q - r.start.q);
  for (int i = 0; i < move.phases; ++i) {
    const auto& [duration, from] = move.phase[static_cast<size_t>(i)];
    total += duration;
    size = std::max(size, std::abs(static_cast<long double>(from.q) - r.start.q));
    for (const double part : {0.25, 0.5, 0.75}) {
      const double t = part * duration;
      const double q = t * (from.qd + t * (from.qdd / 2.0 + from.qddd * t / 6.0));
      size = std::max(size, std::abs(static_cast<long double>(from.q) + q - r.start.q));
    }
  }
  // The start's own rounding counts with the size of the move.
  size += std::abs(r.start.q) * 1e-6L;
  EXPECT_NEAR(static_cast<double>(total), move.total, 1e-12 * move.total);
  const AxisLimits& l = r.limits;
  const double speed = std::max(
      {scale_of(l.velocity_min, l.velocity_max), std::abs(r.start.qd), std::abs(r.end.qd)});
  const double acceleration =
      std::max({scale_of(l.acceleration_min, l.acceleration_max), std::abs(r.start.qdd)});
  for (int i = 0; i < move.phases; ++i) {
    SCOPED_TRACE(i);
    const auto& [duration, from] = move.phase[static_cast<size_t>(i)];
    EXPECT_GT(duration, 0.0);
    EXPECT_LE(from.qddd, l.jerk_max * (1.0 + 1e-12));
    EXPECT_GE(from.qddd, l.jerk_min * (1.0 + 1e-12));
    const AxisState& next =
        i + 1 < move.phases ? move.phase[static_cast<size_t>(i + 1)].from : move.end;
    const long double t = duration, j = from.qddd;
    const long double q = from.q + t * (from.qd + t * (from.qdd / 2.0L + j * t / 6.0L));
    const long double qd = from.qd + t * (from.qdd + j * t / 2.0L);
    EXPECT_LE(std::abs(q - next.q), 1e-9L * size);
    EXPECT_LE(std::abs(qd - next.qd), 1e-12 * speed);
    EXPECT_LE(std::abs(from.qdd + j * t - next.qdd), 1e-12 * acceleration);
  }
}

/// Velocity and acceleration stay within their limits, at the exact extremes of each phase, from
/// the phase `first` on.
inline void expect_limits(const AxisRequest& r, const AxisMove& move, int first = 0) {
  const AxisLimits& l = r.limits;
  const double v_slack = 1e-12 * scale_of(l.velocity_min, l.velocity_max);
  const double a_slack = 1e-12 * scale_of(l.acceleration_min, l.acceleration_max);
  for (int i = first; i < move.phases; ++i) {
    SCOPED_TRACE(i);
    const auto& [duration, from] = move.phase[static_cast<size_t>(i)];
    const double peak = from.qddd != 0.0 ? -from.qdd / from.qddd : 0.0;
    for (const double t : {0.0, std::clamp(peak, 0.0, duration), duration}) {
      const double qd = from.qd + t * (from.qdd + 0.5 * from.qddd * t);
      const double qdd = from.qdd + from.qddd * t;
      EXPECT_LE(qd, l.velocity_max + v_slack);
      EXPECT_GE(qd, l.velocity_min - v_slack);
      EXPECT_LE(qdd, l.acceleration_max + a_slack);
      EXPECT_GE(qdd, l.acceleration_min - a_slack);
    }
  }
}

/// Pontryagin's conditions for three integrators: jerk at a limit, or none with the acceleration or
/// the velocity at its own; and the jerk, limits aside, changes its sign twice at most.
inline void expect_extremal(const AxisRequest& r, const AxisMove& move) {
  const AxisLimits& l = r.limits;
  int changes = 0;
  double last = 0.0;
  for (int i = 0; i < move.phases; ++i) {
    SCOPED_TRACE(i);
    const AxisState& from = move.phase[static_cast<size_t>(i)].from;
    if (from.qddd != 0.0) {
      EXPECT_TRUE(from.qddd == l.jerk_max || from.qddd == l.jerk_min);
      if (last * from.qddd < 0.0) ++changes;
      last = from.qddd;
      continue;
    }
    const auto at = [](double value, double limit) {
      return std::abs(value - limit) <= 1e-12 * std::abs(limit);
    };
    const bool cruises =
        from.qdd == 0.0 && (at(from.qd, l.velocity_max) || at(from.qd, l.velocity_min));
    EXPECT_TRUE(cruises || at(from.qdd, l.acceleration_max) || at(from.qdd, l.acceleration_min))
        << "idles below every limit";
  }
  EXPECT_LE(changes, 2);
}

}  // namespace viapoint::testing
