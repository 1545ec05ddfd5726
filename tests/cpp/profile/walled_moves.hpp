/// @file
/// Random moves between position limits that are in the way, and how far a move reaches.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "profile/axis_move_checks.hpp"

namespace viapoint::testing {

inline constexpr double kNone = std::numeric_limits<double>::infinity();

struct Extent {
  double low, high;
};

/// Of every phase: its ends, and where its velocity vanishes.
inline Extent extent_of(const AxisMove& move) {
  Extent extent{move.at(0.0).q, move.at(0.0).q};
  const auto take = [&](long double q) {
    extent.low = std::min(extent.low, static_cast<double>(q));
    extent.high = std::max(extent.high, static_cast<double>(q));
  };
  for (int i = 0; i < move.phases; ++i) {
    const auto& [duration, from] = move.phase[static_cast<size_t>(i)];
    const auto q = [&, f = from](long double t) {
      return f.q + t * (f.qd + t * (f.qdd / 2.0L + f.qddd * t / 6.0L));
    };
    take(q(duration));
    const long double a = from.qdd, j = from.qddd, under = a * a - 2.0L * j * from.qd;
    std::vector<long double> turns;
    if (j == 0.0L && a != 0.0L) turns.push_back(-from.qd / a);
    if (j != 0.0L && under > 0.0L) {
      turns.push_back((-a + std::sqrt(under)) / j);
      turns.push_back((-a - std::sqrt(under)) / j);
    }
    for (const long double t : turns) {
      if (t > 0.0L && t < duration) take(q(t));
    }
  }
  take(move.end.q);
  return extent;
}

inline AxisLimits without_walls(AxisLimits limits) {
  limits.position_min = -kNone;
  limits.position_max = kNone;
  return limits;
}

inline void expect_inside(const AxisLimits& limits, const AxisMove& move) {
  const Extent extent = extent_of(move);
  const double slack = 1e-9 * (extent.high - extent.low) + 1e-15 * std::abs(extent.high);
  EXPECT_LE(extent.high, limits.position_max + slack);
  EXPECT_GE(extent.low, limits.position_min - slack);
}

/// Walls that the quickest motion without them would break, but that some motion keeps: often just
/// about.
inline AxisRequest random_walled_request(std::mt19937_64& random) {
  for (;;) {
    AxisRequest r = random_request(random, 0.7);
    r.end.q = r.start.q + (r.end.q - r.start.q) * log_uniform(random, 1e-3, 1.0);
    AxisMove move;
    if (quickest_move(r.start, r.end, r.limits, move) != MoveStatus::kSolved) continue;
    const Extent free = extent_of(move);
    double high = std::max(r.start.q, r.end.q), low = std::min(r.start.q, r.end.q);
    if (!(free.high > high + 1e-6) && !(free.low < low - 1e-6)) continue;
    for (int tries = 0; tries < 12; ++tries) {
      const AxisLimits before = r.limits;
      const bool both = random() % 4 == 0;
      if (free.high > high) r.limits.position_max = uniform(random, high, free.high);
      if (free.low < low && (both || !(free.high > high))) {
        r.limits.position_min = uniform(random, free.low, low);
      }
      if (random() % 4 == 0) {
        r.limits.position_max = std::max(r.start.q, r.end.q) + log_uniform(random, 1e-4, 3.0);
      }
      if (quickest_move(r.start, r.end, r.limits, move) == MoveStatus::kSolved) return r;
      if (std::isfinite(r.limits.position_max)) high = r.limits.position_max;
      if (std::isfinite(r.limits.position_min)) low = r.limits.position_min;
      r.limits = before;
      high = std::min(high, free.high);
      low = std::max(low, free.low);
    }
  }
}

constexpr AxisLimits between(double low, double high) {
  AxisLimits limits = AxisLimits::symmetric(1.0, 2.0, 10.0);
  limits.position_min = low;
  limits.position_max = high;
  return limits;
}

}  // namespace viapoint::testing
