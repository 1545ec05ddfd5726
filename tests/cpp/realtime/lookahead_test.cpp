#include "viapoint/realtime/lookahead.hpp"

#include <gtest/gtest.h>

#include <random>

#include "realtime/random_motion.hpp"

namespace viapoint {
namespace {

bool inside(double value, const Range& range, double slack) {
  return value >= range.low - slack && value <= range.high + slack;
}

TEST(Lookahead, RangesHoldTheDerivativesBetweenTheSamplesToo) {
  std::uint64_t checked = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    constexpr double kCell = 1e-3;
    Lookahead lookahead(motion.limits, kCell);
    lookahead.begin(motion.trajectory);
    for (double tau = 0.0; tau < motion.trajectory.duration() - 0.01; tau += 5e-3) {
      lookahead.advance(tau, Lookahead::kCells, 1 << 20);
      DerivativeRanges ranges;
      ASSERT_TRUE(lookahead.ranges(tau, tau + 2e-3, ranges));
      for (int s = 0; s < 50; ++s, ++checked) {
        const JointState state = motion.trajectory.at(tau + 2e-3 * s / 50.0);
        for (int j = 0; j < motion.limits.joints(); ++j) {
          const auto i = static_cast<std::size_t>(j);
          ASSERT_TRUE(inside(state.qd[j], ranges.first[i], 1e-9 * motion.limits.velocity[j]));
          ASSERT_TRUE(inside(state.qdd[j], ranges.second[i], 1e-9 * motion.limits.acceleration[j]));
          ASSERT_TRUE(inside(state.qddd[j], ranges.third[i], 1e-9 * motion.limits.jerk[j]));
        }
      }
    }
  }
  EXPECT_GT(checked, 100000U);
}

TEST(Lookahead, RestsAfterTheEndAndKnowsOnlyItsWindow) {
  std::mt19937 random(3);
  const Motion motion = straight_motion(random);
  Lookahead lookahead(motion.limits, 1e-3);
  lookahead.begin(motion.trajectory);
  DerivativeRanges ranges;
  EXPECT_FALSE(lookahead.ranges(0.0, 1e-3, ranges));
  lookahead.advance(0.0, 10, 1 << 20);
  EXPECT_TRUE(lookahead.ranges(0.0, 9.5e-3, ranges));
  EXPECT_FALSE(lookahead.ranges(0.0, 10.5e-3, ranges));

  const double duration = motion.trajectory.duration();
  for (double tau = 0.0; tau < duration + 0.1; tau += 0.1) {
    lookahead.advance(tau, Lookahead::kCells, 1 << 20);
  }
  EXPECT_FALSE(lookahead.ranges(0.0, 1e-3, ranges));
  ASSERT_TRUE(lookahead.ranges(duration + 0.11, duration + 0.15, ranges));
  for (int j = 0; j < motion.limits.joints(); ++j) {
    EXPECT_EQ(ranges.third[static_cast<std::size_t>(j)].high, 0.0);
    EXPECT_EQ(ranges.third[static_cast<std::size_t>(j)].low, 0.0);
  }
}

}  // namespace
}  // namespace viapoint
