/// @file
/// Checks that every law of one axis must pass.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "viapoint/profile/axis_law.hpp"

namespace viapoint {

/// Neighbouring parts meet in q and its derivatives up to `order`, to `tolerance` times the largest
/// magnitude of the quantity, and to what it changes by in one step of a clock of doubles.
inline void expect_continuous(const AxisLaw& law, int order, double tolerance = 1e-11) {
  const auto get = [](const AxisState& s, int k) {
    return k == 0 ? s.q : (k == 1 ? s.qd : (k == 2 ? s.qdd : s.qddd));
  };
  for (int k = 0; k <= order; ++k) {
    const Extremes range = law.extremes(k);
    const double scale = std::max(std::abs(range.low), std::abs(range.high));
    const Extremes change = law.extremes(std::min(k + 1, 3));
    const double tick = 4e-16 * law.end() * std::max(std::abs(change.low), std::abs(change.high));
    for (size_t i = 1; i < law.parts().size(); ++i) {
      const double left = get(law.parts()[i - 1].at(law.parts()[i - 1].t1), k);
      const double right = get(law.parts()[i].at(law.parts()[i].t0), k);
      EXPECT_NEAR(left, right, tolerance * scale + tick)
          << "derivative " << k << " into part " << i;
    }
  }
}

/// Extremes contain what dense samples reach, and are reached at the times they name.
inline void expect_extremes_hold(const AxisLaw& law) {
  const auto get = [](const AxisState& s, int k) {
    return k == 0 ? s.q : (k == 1 ? s.qd : (k == 2 ? s.qdd : s.qddd));
  };
  for (int k = 0; k <= 3; ++k) {
    const Extremes range = law.extremes(k);
    const double scale = std::max({std::abs(range.low), std::abs(range.high), 1e-300});
    double low = INFINITY, high = -INFINITY;
    for (const Polynomial& part : law.parts()) {
      for (int i = 0; i <= 200; ++i) {
        const double value = get(part.at(part.t0 + (part.t1 - part.t0) * i / 200.0), k);
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
    EXPECT_LE(range.low, low + 1e-12 * scale) << "derivative " << k;
    EXPECT_GE(range.high, high - 1e-12 * scale) << "derivative " << k;
    // Samples 1/200 apart miss a smooth peak by little: the extremes are no mere bounds.
    EXPECT_NEAR(range.low, low, 2e-3 * scale) << "derivative " << k;
    EXPECT_NEAR(range.high, high, 2e-3 * scale) << "derivative " << k;
    ASSERT_GE(range.low_time, law.start());
    ASSERT_LE(range.high_time, law.end());
  }
}

}  // namespace viapoint
