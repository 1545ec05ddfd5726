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

/// The motion's derivatives at a time along the way.
JointState along(const Trajectory& motion, Direction direction, double way) {
  if (direction == Direction::kForward) return motion.at(way);
  JointState state = motion.at(motion.duration() - way);
  state.qd = -state.qd;
  state.qddd = -state.qddd;
  return state;
}

void expect_inside(const JointState& state, const DerivativeRanges& ranges,
                   const JointLimits& limits) {
  for (int j = 0; j < limits.joints(); ++j) {
    ASSERT_TRUE(inside(state.qd[j], ranges.first, j, 1e-9 * limits.velocity[j]));
    ASSERT_TRUE(inside(state.qdd[j], ranges.second, j, 1e-9 * limits.acceleration[j]));
    ASSERT_TRUE(inside(state.qddd[j], ranges.third, j, 1e-9 * limits.jerk[j]));
  }
}

/// Asserts that what is told of stretches all along a motion, from any part of a cell to the next
/// but one, holds its derivatives at `samples` moments of each, and narrower at their beginning.
void expect_bounds(const Motion& motion, Direction direction, double cell, int samples,
                   std::uint64_t& checked) {
  Lookahead lookahead(motion.limits, cell);
  lookahead.begin(motion.trajectory, direction);
  const double duration = motion.trajectory.duration();
  for (std::int64_t c = 0; static_cast<double>(c) * cell < duration; ++c) {
    lookahead.advance(static_cast<double>(c) * cell, 3, kAnyNumber);
    const double from = cell * (static_cast<double>(c) + uniform_share(checked));
    const double time = 2.0 * cell * uniform_share(checked / 3);
    if (from >= duration) return;
    PathStretch stretch;
    ASSERT_TRUE(lookahead.ranges(from, from + time, stretch));
    for (int s = 0; s < samples; ++s, ++checked) {
      const double t = from + time * (s + uniform_share(checked)) / samples;
      if (t >= duration) break;
      ASSERT_NO_FATAL_FAILURE(
          expect_inside(along(motion.trajectory, direction, t), stretch.ranges, motion.limits))
          << t << " in " << from << " and " << time;
    }
    const DerivativeRanges there{stretch.first_there, stretch.second_there, stretch.ranges.third};
    ASSERT_NO_FATAL_FAILURE(
        expect_inside(along(motion.trajectory, direction, from), there, motion.limits))
        << "at the beginning, " << from;
  }
}

Direction any_direction(unsigned seed) {
  return seed / 7 % 2 == 0 ? Direction::kForward : Direction::kBackward;
}

TEST(Lookahead, RangesHoldTheDerivativesBetweenTheSamplesToo) {
  std::uint64_t checked = 0;
  for (unsigned seed = 0; seed < kMotions; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    expect_bounds(motion, any_direction(seed), 1e-3 * (1U << (seed % 7)), 6, checked);
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
    expect_bounds(motion, any_direction(seed), 1e-3 * (1U << (seed % 7)), 8, checked);
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
  PathStretch stretch;
  const DerivativeRanges& ranges = stretch.ranges;
  lookahead.advance(0.0, 8, kAnyNumber);
  ASSERT_TRUE(lookahead.ranges(0.049, 0.055, stretch));  // jerk 200 until 0.1 s: cell 0.048 … 0.056
  EXPECT_NEAR(ranges.third.low(0), 200.0, 1e-6);
  EXPECT_NEAR(ranges.third.high(0), 200.0, 1e-6);
  EXPECT_NEAR(ranges.second.low(0), 9.8, 1e-6);
  EXPECT_NEAR(ranges.second.high(0), 11.0, 1e-6);
  EXPECT_NEAR(ranges.first.low(0), 100.0 * 0.049 * 0.049, 1e-6);
  EXPECT_NEAR(ranges.first.high(0), 100.0 * 0.055 * 0.055, 4e-3);
  EXPECT_NEAR(stretch.second_there.high(0), 9.8, 1e-6);
  EXPECT_NEAR(stretch.first_there.high(0), 100.0 * 0.049 * 0.049, 1e-6);
}

TEST(Lookahead, LooksAtNoMorePiecesACallThanToldAndGetsToTheSameRanges) {
  const Motion motion = dense_motion(4000);
  constexpr double kCell = 0.032;  // some 2600 pieces
  Lookahead slow(motion.limits, kCell), quick(motion.limits, kCell);
  slow.begin(motion.trajectory);
  quick.begin(motion.trajectory);
  EXPECT_GT(quick.advance(0.0, 3, kAnyNumber), 5000);
  PathStretch got, expected;
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
    EXPECT_EQ(got.ranges.first.low(i), expected.ranges.first.low(i));
    EXPECT_EQ(got.ranges.second.high(i), expected.ranges.second.high(i));
    EXPECT_EQ(got.ranges.third.low(i), expected.ranges.third.low(i));
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
  PathStretch got, expected;
  EXPECT_FALSE(late.ranges(tau - kCell, tau, got));
  ASSERT_TRUE(late.ranges(tau, tau + 2.0 * kCell, got));
  ASSERT_TRUE(quick.ranges(tau, tau + 2.0 * kCell, expected));
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(got.ranges.first.low(i), expected.ranges.first.low(i));
    EXPECT_EQ(got.ranges.first.high(i), expected.ranges.first.high(i));
    EXPECT_EQ(got.ranges.third.low(i), expected.ranges.third.low(i));
  }
}

TEST(Lookahead, RestsAfterTheEndAndKnowsOnlyItsWindow) {
  std::mt19937 random(3);
  const Motion motion = straight_motion(random);
  Lookahead lookahead(motion.limits, 1e-3);
  lookahead.begin(motion.trajectory);
  PathStretch stretch;
  const DerivativeRanges& ranges = stretch.ranges;
  EXPECT_FALSE(lookahead.ranges(0.0, 1e-3, stretch));
  lookahead.advance(0.0, 10, kAnyNumber);
  EXPECT_TRUE(lookahead.ranges(0.0, 9.5e-3, stretch));
  EXPECT_FALSE(lookahead.ranges(0.0, 10.5e-3, stretch));

  const double duration = motion.trajectory.duration();
  for (double tau = 0.0; tau < duration + 0.1; tau += 0.1) {
    lookahead.advance(tau, Lookahead::kCells, kAnyNumber);
  }
  EXPECT_FALSE(lookahead.ranges(0.0, 1e-3, stretch));
  ASSERT_TRUE(lookahead.ranges(duration + 0.11, duration + 0.15, stretch));
  for (int j = 0; j < motion.limits.joints(); ++j) {
    EXPECT_EQ(ranges.third.high(j), 0.0);
    EXPECT_EQ(ranges.third.low(j), 0.0);
  }
}

}  // namespace
}  // namespace viapoint
