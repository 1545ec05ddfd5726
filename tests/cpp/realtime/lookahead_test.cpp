#include "viapoint/realtime/lookahead.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "problem_count.hpp"
#include "realtime/random_motion.hpp"

namespace viapoint {
namespace {

bool inside(double value, const JointRanges& ranges, int joint, double slack) {
  return value >= ranges.low(joint) - slack && value <= ranges.high(joint) + slack;
}

constexpr int kAnyNumber = 1 << 20;
constexpr unsigned kMotions = problems(2000U);

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Pieces whose path bends and whose timing does too, so that every term of the chain rule counts;
/// limits that they just reach. They do not meet, which the look-ahead does not mind.
Motion composed_motion(std::mt19937& random) {
  const int joints = std::uniform_int_distribution<int>(1, 3)(random);
  std::vector<TrajectoryPiece> pieces(6);
  const double typical = std::exp(uniform(random, std::log(0.01), std::log(1.0)));
  for (TrajectoryPiece& piece : pieces) {
    piece.joints = joints;
    piece.duration = typical * uniform(random, 0.3, 3.0);
    for (auto& row : piece.path) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(joints); ++i) {
        row[i] = uniform(random, -1.0, 1.0);
      }
    }
    double sum = 0.0;
    for (std::size_t k = 1; k < 6; ++k) sum += piece.timing[k] = uniform(random, -0.1, 1.0);
    for (double& c : piece.timing) c /= std::max(sum, 0.5);
  }
  return motion_at_its_limits(std::move(pieces));
}

/// Spreads the samples: the fractional parts of multiples of the golden ratio.
double uniform_share(std::uint64_t n) {
  return std::fmod(0.6180339887498949 * static_cast<double>(n), 1.0);
}

/// Asserts that the cells of a whole motion hold its derivatives at `samples` moments of each.
void expect_bounds(const Motion& motion, double cell, int samples, std::uint64_t& checked) {
  Lookahead lookahead(motion.limits, cell);
  lookahead.begin(motion.trajectory);
  const double duration = motion.trajectory.duration();
  for (std::int64_t c = 0; static_cast<double>(c) * cell < duration; ++c) {
    const double tau = static_cast<double>(c) * cell;
    lookahead.advance(tau, 2, kAnyNumber);
    DerivativeRanges ranges;
    ASSERT_TRUE(lookahead.ranges(tau, tau + 0.5 * cell, ranges));
    for (int s = 0; s < samples; ++s, ++checked) {
      const double t = tau + cell * (s + uniform_share(checked)) / samples;
      if (t >= duration) break;
      const JointState state = motion.trajectory.at(t);
      for (int j = 0; j < motion.limits.joints(); ++j) {
        ASSERT_TRUE(inside(state.qd[j], ranges.first, j, 1e-9 * motion.limits.velocity[j])) << t;
        ASSERT_TRUE(inside(state.qdd[j], ranges.second, j, 1e-9 * motion.limits.acceleration[j]))
            << t;
        ASSERT_TRUE(inside(state.qddd[j], ranges.third, j, 1e-9 * motion.limits.jerk[j])) << t;
      }
    }
  }
}

TEST(Lookahead, RangesHoldTheDerivativesBetweenTheSamplesToo) {
  std::uint64_t checked = 0;
  for (unsigned seed = 0; seed < kMotions; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    expect_bounds(motion, 1e-3 * (1U << (seed % 7)), 12, checked);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(checked, 100000U);
}

TEST(Lookahead, RangesHoldWherePathAndTimingBothBend) {
  std::uint64_t checked = 0;
  for (unsigned seed = 0; seed < kMotions; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = composed_motion(random);
    expect_bounds(motion, 1e-3 * (1U << (seed % 7)), 16, checked);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(checked, 100000U);
}

TEST(Lookahead, RangesOfPhasesOfConstantJerkAreTight) {
  Motion motion;
  motion.limits = even_limits(1, 2.0, 20.0, 200.0);
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(1), JointVector::Constant(1, 20.0), motion.limits, 0);
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  Lookahead lookahead(motion.limits, 8e-3);
  lookahead.begin(motion.trajectory);
  DerivativeRanges ranges;
  lookahead.advance(0.0, 8, kAnyNumber);
  ASSERT_TRUE(lookahead.ranges(0.049, 0.055, ranges));  // jerk 200 until 0.1 s: cell 0.048 … 0.056
  EXPECT_NEAR(ranges.third.low(0), 200.0, 1e-6);
  EXPECT_NEAR(ranges.second.low(0), 9.6, 1e-6);
  EXPECT_NEAR(ranges.second.high(0), 11.2, 1e-6);
  EXPECT_NEAR(ranges.first.low(0), 100.0 * 0.048 * 0.048, 2e-3);
  EXPECT_NEAR(ranges.first.high(0), 100.0 * 0.056 * 0.056, 2e-3);
}

TEST(Lookahead, LooksAtNoMorePiecesACallThanToldAndGetsToTheSameRanges) {
  const Motion motion = dense_motion(4000);
  constexpr double kCell = 0.032;  // some 2600 pieces
  Lookahead slow(motion.limits, kCell), quick(motion.limits, kCell);
  slow.begin(motion.trajectory);
  quick.begin(motion.trajectory);
  EXPECT_GT(quick.advance(0.0, 3, kAnyNumber), 5000);
  DerivativeRanges got, expected;
  ASSERT_TRUE(quick.ranges(0.0, 2.5 * kCell, expected));
  EXPECT_EQ(slow.advance(0.0, 8, 100), 100);
  EXPECT_FALSE(slow.ranges(0.0, 0.5 * kCell, got)) << "a cell half done is not known";
  int calls = 1;
  for (; !slow.ranges(0.0, 2.5 * kCell, got); ++calls) {
    ASSERT_LE(slow.advance(0.0, 8, 100), 100);
    ASSERT_LT(calls, 1000);
  }
  EXPECT_GT(calls, 50);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(got.first.low(i), expected.first.low(i));
    EXPECT_EQ(got.second.high(i), expected.second.high(i));
    EXPECT_EQ(got.third.low(i), expected.third.low(i));
  }
}

TEST(Lookahead, FindsTheFutureAgainAfterTheMotionHasOvertakenIt) {
  const Motion motion = dense_motion(4000);
  constexpr double kCell = 2e-3;
  Lookahead late(motion.limits, kCell), quick(motion.limits, kCell);
  late.begin(motion.trajectory);
  quick.begin(motion.trajectory);
  EXPECT_EQ(late.advance(0.0, 8, 10), 10);
  const double tau = 20.5 * kCell;
  late.advance(tau, 4, kAnyNumber);
  quick.advance(0.0, 30, kAnyNumber);
  DerivativeRanges got, expected;
  EXPECT_FALSE(late.ranges(tau - kCell, tau, got));
  ASSERT_TRUE(late.ranges(tau, tau + 2.0 * kCell, got));
  ASSERT_TRUE(quick.ranges(tau, tau + 2.0 * kCell, expected));
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(got.first.low(i), expected.first.low(i));
    EXPECT_EQ(got.first.high(i), expected.first.high(i));
    EXPECT_EQ(got.third.low(i), expected.third.low(i));
  }
}

TEST(Lookahead, RestsAfterTheEndAndKnowsOnlyItsWindow) {
  std::mt19937 random(3);
  const Motion motion = straight_motion(random);
  Lookahead lookahead(motion.limits, 1e-3);
  lookahead.begin(motion.trajectory);
  DerivativeRanges ranges;
  EXPECT_FALSE(lookahead.ranges(0.0, 1e-3, ranges));
  lookahead.advance(0.0, 10, kAnyNumber);
  EXPECT_TRUE(lookahead.ranges(0.0, 9.5e-3, ranges));
  EXPECT_FALSE(lookahead.ranges(0.0, 10.5e-3, ranges));

  const double duration = motion.trajectory.duration();
  for (double tau = 0.0; tau < duration + 0.1; tau += 0.1) {
    lookahead.advance(tau, Lookahead::kCells, kAnyNumber);
  }
  EXPECT_FALSE(lookahead.ranges(0.0, 1e-3, ranges));
  ASSERT_TRUE(lookahead.ranges(duration + 0.11, duration + 0.15, ranges));
  for (int j = 0; j < motion.limits.joints(); ++j) {
    EXPECT_EQ(ranges.third.high(j), 0.0);
    EXPECT_EQ(ranges.third.low(j), 0.0);
  }
}

}  // namespace
}  // namespace viapoint
