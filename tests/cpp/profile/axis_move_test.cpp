#include "viapoint/profile/axis_move.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "problem_count.hpp"
#include "profile/axis_move_checks.hpp"

namespace viapoint {
namespace {

using testing::AxisRequest;
using testing::expect_connected;
using testing::expect_extremal;
using testing::expect_limits;
using testing::log_uniform;
using testing::uniform;

constexpr AxisLimits kPlain = AxisLimits::symmetric(1.0, 2.0, 10.0);

AxisMove solved(const AxisRequest& r) {
  AxisMove move;
  EXPECT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
  return move;
}

template <typename Make>
void sweep(int count, Make make) {
  for (int seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const AxisRequest r = make(random);
    const AxisMove move = solved(r);
    expect_connected(r, move);
    expect_limits(r, move);
    expect_extremal(r, move);
    EXPECT_LE(move.phases, 7);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(QuickestMove, IsExactWithinLimitsAndExtremalOnEverydayProblems) {
  sweep(30000, [](std::mt19937_64& random) { return testing::random_request(random, 0.7); });
}

TEST(QuickestMove, IsExactWithinLimitsAndExtremalOverDecades) {
  sweep(30000, [](std::mt19937_64& random) { return testing::random_request(random, 3.0); });
}

TEST(QuickestMove, IsExactWithinLimitsAndExtremalOnShortMoves) {
  sweep(30000, [](std::mt19937_64& random) { return testing::random_short_request(random); });
}

TEST(QuickestMove, IsTheRestToRestMoveFromRest) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double v = log_uniform(random, 1e-6, 1e9), a = log_uniform(random, 1e-6, 1e9),
                 j = log_uniform(random, 1e-6, 1e9), way = log_uniform(random, 1e-9, 1e9);
    const AxisMove move = solved({{}, {-way, 0.0, 0.0, 0.0}, AxisLimits::symmetric(v, a, j)});
    const double expected = rest_to_rest(-way, v, a, j).total();
    EXPECT_NEAR(move.total, expected, 1e-12 * expected);
    if (HasFailure()) return;
  }
}

/// Read backwards, with velocities kept and accelerations turned, a motion is one of the same
/// length the other way: v'(t) = v(T − t), a'(t) = −a(T − t), and the jerk as it was.
TEST(QuickestMove, TakesAsLongReadBackwards) {
  for (int seed = 0; seed < problems(5000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const AxisRequest r = testing::random_request(random, 1.0);
    const AxisLimits& l = r.limits;
    const AxisRequest back{{0.0, r.end.qd, -r.end.qdd, 0.0},
                           {r.end.q - r.start.q, r.start.qd, -r.start.qdd, 0.0},
                           {l.velocity_min, l.velocity_max, -l.acceleration_max,
                            -l.acceleration_min, l.jerk_min, l.jerk_max}};
    AxisMove backwards;
    // A start may come from outside the limits, an end may not.
    if (quickest_move(back.start, back.end, back.limits, backwards) != MoveStatus::kSolved)
      continue;
    const AxisMove forwards = solved(r);
    if (backwards.phases > 0 && forwards.phases > 0) {
      EXPECT_NEAR(backwards.total, forwards.total, 1e-9 * forwards.total);
    }
    if (HasFailure()) return;
  }
}

TEST(QuickestMove, GoesOnAsPlannedFromAnyOfItsStates) {
  for (int seed = 0; seed < problems(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 0.7);
    r.end.qd = r.end.qdd = 0.0;
    const AxisMove move = solved(r);
    for (int i = 0; i < 10; ++i) {
      const double t = uniform(random, 0.0, move.total);
      r.start = move.at(t);
      const AxisMove rest = solved(r);
      // Rounding of the state costs the cube root of it, about (1e-16)^(1/3).
      EXPECT_NEAR(rest.total, move.total - t, 1e-3 * move.total);
      expect_connected(r, rest);
      expect_limits(r, rest);
    }
    if (HasFailure()) return;
  }
}

TEST(QuickestMove, SurvivesResidualsOfRounding) {
  for (const double residual : {1e-300, 1e-20, 1e-17, 1e-16, 1e-15, 1e-14, 1e-12}) {
    for (const double sign : {-1.0, 1.0}) {
      SCOPED_TRACE(sign * residual);
      const double e = sign * residual;
      for (const AxisState& start :
           {AxisState{e, 0.0, 0.0, 0.0}, AxisState{0.0, e, 0.0, 0.0}, AxisState{0.0, 0.0, e, 0.0},
            AxisState{e, e, e, 0.0}, AxisState{e, -e, e, 0.0}, AxisState{-e, e, -e, 0.0}}) {
        const AxisRequest r{start, {}, kPlain};
        const AxisMove move = solved(r);
        expect_limits(r, move);
        EXPECT_LT(move.total, 1e-3);
        const AxisRequest away{start, {1.0, 0.0, 0.0, 0.0}, kPlain};
        expect_connected(away, solved(away));
        const AxisRequest onto{{}, {1.0, start.qd, start.qdd, 0.0}, kPlain};
        expect_connected(onto, solved(onto));
      }
    }
  }
}

TEST(QuickestMove, StartsAndEndsOnItsLimits) {
  for (const double v0 : {-1.0, 1.0}) {
    for (const double v1 : {-1.0, 1.0}) {
      for (const double way : {-3.0, -0.1, 0.0, 1e-9, 0.1, 3.0}) {
        const AxisRequest r{{0.0, v0, 0.0, 0.0}, {way, v1, 0.0, 0.0}, kPlain};
        const AxisMove move = solved(r);
        expect_connected(r, move);
        expect_limits(r, move);
      }
    }
  }
  // Accelerating at the limit and just able to meet the velocity limit: 0.8 + 2²/(2·10) = 1.
  const AxisRequest r{{0.0, 0.8, 2.0, 0.0}, {5.0, 0.8, -2.0, 0.0}, kPlain};
  const AxisMove move = solved(r);
  expect_connected(r, move);
  expect_limits(r, move);
}

TEST(QuickestMove, LastsHoursWhereItMust) {
  const AxisRequest r{{}, {1e4, 0.0, 0.0, 0.0}, kPlain};
  const AxisMove move = solved(r);
  expect_connected(r, move);
  expect_limits(r, move);
  EXPECT_NEAR(move.total, 1e4 + 0.7, 1e-8);  // v/a + a/j more than at full speed all the way
}

TEST(QuickestMove, DoesNothingWhereItIs) {
  const AxisState there{0.3, 0.2, -0.1, 0.0};
  const AxisMove move = solved({there, there, kPlain});
  EXPECT_EQ(move.phases, 0);
  EXPECT_EQ(move.total, 0.0);
  EXPECT_EQ(move.at(1.0).q, 0.3);
  EXPECT_EQ(move.at(1.0).qd, 0.2);
}

/// The first phase from which the limits can hold: the acceleration is within, and the velocity
/// will be once the acceleration has gone to zero at full jerk.
int first_inside(const AxisRequest& r, const AxisMove& move) {
  const AxisLimits& l = r.limits;
  int first = 0;
  for (int i = 0; i < move.phases; ++i) {
    const AxisState& s = move.phase[static_cast<size_t>(i)].from;
    const double jerk = s.qdd > 0.0 ? l.jerk_min : l.jerk_max;
    const double level = s.qd - s.qdd * s.qdd / (2.0 * jerk);
    const double slack = 1e-12 * (std::abs(s.qd) + s.qdd * s.qdd / std::abs(jerk));
    const bool inside = level <= l.velocity_max + slack && level >= l.velocity_min - slack &&
                        s.qd <= l.velocity_max && s.qd >= l.velocity_min &&
                        s.qdd <= l.acceleration_max && s.qdd >= l.acceleration_min;
    if (!inside) first = i + 1;
  }
  return first;
}

TEST(QuickestMove, ComesBackInsideAndStaysThere) {
  for (int seed = 0; seed < problems(20000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 0.7);
    const AxisLimits& l = r.limits;
    r.start.qd = uniform(random, 3.0 * l.velocity_min, 3.0 * l.velocity_max);
    r.start.qdd = uniform(random, 3.0 * l.acceleration_min, 3.0 * l.acceleration_max);
    const AxisMove move = solved(r);
    expect_connected(r, move);
    EXPECT_LE(move.phases, 9);
    expect_limits(r, move, first_inside(r, move));
    // Outside, the acceleration only comes nearer: it never goes beyond where it began.
    for (int i = 0; i < move.phases; ++i) {
      const AxisState& s = move.phase[static_cast<size_t>(i)].from;
      EXPECT_LE(s.qdd, std::max(l.acceleration_max, r.start.qdd));
      EXPECT_GE(s.qdd, std::min(l.acceleration_min, r.start.qdd));
    }
    if (HasFailure()) return;
  }
}

TEST(QuickestMove, NeverReversesWhenTheSpeedLimitIsLoweredInMotion) {
  for (int seed = 0; seed < problems(5000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 0.7);
    r.start.qd = r.start.qdd = r.end.qd = r.end.qdd = 0.0;
    r.end.q = r.start.q + 20.0;
    const AxisMove fast = solved(r);
    r.start = fast.at(uniform(random, 0.0, 0.3) * fast.total);
    r.limits.velocity_max *= log_uniform(random, 0.05, 1.0);
    const AxisMove slow = solved(r);
    // Where it can stop before the target anyway; past it, turning back is the only way.
    AxisMove stop;
    ASSERT_EQ(quickest_velocity_change(r.start, {}, r.limits, stop), MoveStatus::kSolved);
    if (stop.end.q > r.end.q) continue;
    for (int i = 0; i <= 200; ++i) {
      EXPECT_GE(slow.at(slow.total * i / 200.0).qd, -1e-12);
    }
    if (HasFailure()) return;
  }
}

TEST(QuickestMove, NamesWhatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  AxisMove move;
  const auto status = [&](const AxisState& start, const AxisState& end, const AxisLimits& limits) {
    return quickest_move(start, end, limits, move);
  };
  EXPECT_EQ(status({}, {1.0, 1.1, 0.0, 0.0}, kPlain), MoveStatus::kEndVelocity);
  EXPECT_EQ(status({}, {1.0, 0.0, -2.1, 0.0}, kPlain), MoveStatus::kEndAcceleration);
  // 0.9 was 0.9 + 2²/(2·10) = 1.1 before the acceleration was −2.
  EXPECT_EQ(status({}, {1.0, 0.9, -2.0, 0.0}, kPlain), MoveStatus::kEndUnreachable);
  EXPECT_EQ(status({}, {1.0, 0.9, 2.0, 0.0}, kPlain), MoveStatus::kSolved);
  EXPECT_EQ(status({nan, 0.0, 0.0, 0.0}, {}, kPlain), MoveStatus::kBadState);
  EXPECT_EQ(status({}, {0.0, 0.0, infinite, 0.0}, kPlain), MoveStatus::kBadState);
  EXPECT_EQ(status({-1.7e308, 0.0, 0.0, 0.0}, {1.7e308, 0.0, 0.0, 0.0}, kPlain),
            MoveStatus::kBadState);
  for (int field = 0; field < 6; ++field) {
    for (const double bad : {nan, infinite, -infinite, 0.0}) {
      AxisLimits limits = kPlain;
      double* const fields[] = {&limits.velocity_min,     &limits.velocity_max,
                                &limits.acceleration_min, &limits.acceleration_max,
                                &limits.jerk_min,         &limits.jerk_max};
      *fields[field] = bad;
      EXPECT_EQ(status({}, {1.0, 0.0, 0.0, 0.0}, limits), MoveStatus::kBadLimits);
    }
  }
  const AxisLimits swapped{1.0, -1.0, -2.0, 2.0, -10.0, 10.0};
  EXPECT_EQ(status({}, {1.0, 0.0, 0.0, 0.0}, swapped), MoveStatus::kBadLimits);
}

TEST(QuickestVelocityChange, EndsAtTheVelocityAndIsExtremal) {
  for (int seed = 0; seed < problems(20000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 1.0);
    AxisMove move;
    ASSERT_EQ(quickest_velocity_change(r.start, r.end, r.limits, move), MoveStatus::kSolved);
    r.end.q = move.end.q;
    expect_connected(r, move);
    expect_limits(r, move);
    expect_extremal(r, move);
    EXPECT_LE(move.phases, 3);
    // Nothing that also has to be somewhere is quicker.
    AxisRequest other = r;
    other.end.q += uniform(random, -1.0, 1.0);
    EXPECT_GE(solved(other).total, move.total * (1.0 - 1e-12));
    EXPECT_NEAR(solved(r).total, move.total, 1e-3 * (1.0 + move.total));
    if (HasFailure()) return;
  }
}

TEST(AxisMove, IsClampedToItsDuration) {
  const AxisMove move = solved({{}, {1.0, 0.0, 0.0, 0.0}, kPlain});
  EXPECT_EQ(move.at(-1.0).q, 0.0);
  EXPECT_EQ(move.at(std::numeric_limits<double>::quiet_NaN()).q, 0.0);
  EXPECT_EQ(move.at(move.total).q, 1.0);
  EXPECT_EQ(move.at(1e300).q, 1.0);
  EXPECT_NEAR(move.at(move.total * (1.0 - 1e-15)).q, 1.0, 1e-14);
}

}  // namespace
}  // namespace viapoint
