#include "viapoint/core/scalar_minimum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace viapoint {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

TEST(ScalarMinimum, FindsTheLowestPointOfAnyFunctionWithOneValley) {
  for (int seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const double bottom = any(random), power = 1.0 + (any(random) + 1.0), steep = 1.5 + any(random);
    const auto valley = [&](double x) {
      const double away = std::abs(x - bottom);
      return (x > bottom ? steep : 1.0) * std::pow(away, power);
    };
    const ScalarMinimum least = least_of(-2.0, 2.0, 9, 60, valley);
    EXPECT_NEAR(least.x, bottom, 2e-6);
    EXPECT_EQ(least.value, valley(least.x));
    if (HasFailure()) return;
  }
}

TEST(ScalarMinimum, StaysInItsBracketAndWithinItsSteps) {
  for (int seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(0.0, 1.0);
    const double left = -any(random), right = any(random);
    int calls = 0;
    double lowest = 0.5;
    const ScalarMinimum best = refined_minimum(left, right, {0.0, lowest}, 1e-9, 20, [&](double x) {
      ++calls;
      EXPECT_GE(x, left);
      EXPECT_LE(x, right);
      const double value = any(random);  // no valley at all
      lowest = std::min(lowest, value);
      return value;
    });
    EXPECT_LE(calls, 20);
    EXPECT_EQ(best.value, lowest);
    if (HasFailure()) return;
  }
}

TEST(ScalarMinimum, LooksBesidePlacesWithoutAValue) {
  const auto ledge = [](double x) { return x < 0.3 ? kNever : x; };
  const ScalarMinimum least = least_of(0.0, 1.0, 9, 60, ledge);
  EXPECT_NEAR(least.x, 0.3, 1e-6);
  EXPECT_EQ(least_of(0.0, 1.0, 9, 60, [](double) { return kNever; }).value, kNever);
}

TEST(ScalarMinimum, TakesAnEndFromWhichTheFunctionRisesAsItIs) {
  for (const double slope : {-2.0, 2.0}) {
    int calls = 0;
    const auto ramp = [&](double x) {
      ++calls;
      return slope * x;
    };
    const ScalarMinimum least = least_of(-1.0, 3.0, 9, 60, ramp);
    EXPECT_EQ(least.x, slope > 0.0 ? -1.0 : 3.0);
    EXPECT_LE(calls, 10);
  }
  // But one that falls to just beside the end is followed there.
  const auto near_end = [](double x) { return std::abs(x - 1e-3); };
  EXPECT_NEAR(least_of(0.0, 1.0, 9, 60, near_end).x, 1e-3, 1e-6);
}

TEST(ScalarMinimum, TakesAnIntervalOfNoLengthAsItIs) {
  const ScalarMinimum least = least_of(2.0, 2.0, 9, 60, [](double x) { return x; });
  EXPECT_EQ(least.x, 2.0);
  EXPECT_EQ(least.value, 2.0);
}

}  // namespace
}  // namespace viapoint
