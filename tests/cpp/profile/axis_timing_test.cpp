#include "viapoint/profile/axis_timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "problem_count.hpp"
#include "profile/law_checks.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/profile/trapezoid.hpp"

namespace viapoint {
namespace {

std::vector<AxisLaw> three_moves(int seed) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  std::uniform_real_distribution<double> any(-3.0, 3.0);
  std::vector<AxisLaw> laws;
  for (int axis = 0; axis < 3; ++axis) {
    JerkProfile move = rest_to_rest(any(random), std::exp(any(random)), std::exp(any(random)),
                                    std::exp(any(random)));
    move.start.q = any(random);
    laws.emplace_back(move);
  }
  return laws;
}

class TimedTogether : public ::testing::TestWithParam<AxisTiming> {};

TEST_P(TimedTogether, KeepsEndsContinuityAndEveryPeak) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<AxisLaw> alone = three_moves(seed);
    const std::vector<AxisLaw> together = timed_together(alone, GetParam());
    ASSERT_EQ(together.size(), alone.size());
    for (size_t axis = 0; axis < alone.size(); ++axis) {
      const AxisLaw& law = together[axis];
      EXPECT_EQ(law.start(), together[0].start());
      EXPECT_EQ(law.end(), together[0].end());
      EXPECT_EQ(law.at(law.start()).q, alone[axis].at(alone[axis].start()).q);
      EXPECT_NEAR(law.at(law.end()).q, alone[axis].at(alone[axis].end()).q, 1e-10);
      expect_continuous(law, 2, 1e-9);
      for (int order = 1; order <= 3; ++order) {
        const Extremes own = alone[axis].extremes(order), now = law.extremes(order);
        // Also what one step of a clock of doubles changes, where the part ends later on it.
        const Extremes change = alone[axis].extremes(std::min(order + 1, 3));
        const double rounding = 1e-12 * std::max(own.high, -own.low) +
                                4e-16 * law.end() * std::max(change.high, -change.low);
        EXPECT_LE(now.high, own.high + rounding);
        EXPECT_GE(now.low, own.low - rounding);
      }
    }
    if (testing::Test::HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(AllTimings, TimedTogether,
                         ::testing::Values(AxisTiming::kSequential, AxisTiming::kSimultaneous,
                                           AxisTiming::kSynchronised));

TEST(TimedTogether, LastsAsTheTimingSays) {
  const std::vector<AxisLaw> laws{bang_bang(0, 1, 4).law, bang_bang(0, 1, 1).law};  // 1 s and 2 s
  EXPECT_EQ(timed_together(laws, AxisTiming::kSequential)[0].end(), 3.0);
  EXPECT_EQ(timed_together(laws, AxisTiming::kSequential)[1].at(1.0).qd, 0.0);
  EXPECT_EQ(timed_together(laws, AxisTiming::kSimultaneous)[0].end(), 2.0);
  EXPECT_EQ(timed_together(laws, AxisTiming::kSimultaneous)[0].at(1.0).q, 1.0);
  const AxisLaw stretched = timed_together(laws, AxisTiming::kSynchronised)[0];
  EXPECT_EQ(stretched.end(), 2.0);
  EXPECT_EQ(stretched.at(1.0).q, 0.5);
  EXPECT_EQ(stretched.extremes(2).high, 1.0);  // a quarter of 4, in twice the time
}

TEST(TimedTogether, RefusesToRestAtSpeed) {
  const std::vector<AxisLaw> laws{AxisLaw({cubic({0, 1}, {1, 0}, 0, 1)}),
                                  AxisLaw({cubic({0, 0}, {1, 0}, 0, 2)})};
  EXPECT_NO_THROW(static_cast<void>(timed_together(laws, AxisTiming::kSimultaneous)));
  const std::vector<AxisLaw> turned{laws[1], laws[0]};
  try {
    static_cast<void>(timed_together(turned, AxisTiming::kSequential));
    FAIL() << "accepted";
  } catch (const MotionError& error) {
    EXPECT_NE(std::string(error.what()).find("velocity of 1"), std::string::npos) << error.what();
  }
}

TEST(TimedTogether, RefusesLawsThatBeginApart) {
  const std::vector<AxisLaw> laws{resting(0, 0, 1), resting(0, 0.5, 1)};
  EXPECT_THROW(static_cast<void>(timed_together(laws, AxisTiming::kSynchronised)), MotionError);
  EXPECT_THROW(static_cast<void>(timed_together({}, AxisTiming::kSynchronised)), MotionError);
}

TEST(AxisLawInTime, RefusesTimesThatCannotBe) {
  const AxisLaw law = resting(1.0, 0.0, 1.0);
  EXPECT_THROW(static_cast<void>(resting(1.0, 1.0, 1.0)), MotionError);
  EXPECT_THROW(static_cast<void>(stretched(law, 0.0)), MotionError);
  EXPECT_THROW(static_cast<void>(stretched(law, std::nan(""))), MotionError);
  EXPECT_THROW(static_cast<void>(delayed(law, std::numeric_limits<double>::infinity())),
               MotionError);
  EXPECT_THROW(static_cast<void>(delayed(law, 1e300)), MotionError);  // nothing is left of it
}

}  // namespace
}  // namespace viapoint
