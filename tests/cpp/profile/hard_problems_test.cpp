// The problems on which other solvers are known to fail, by the thousand and for states of any
// kind: limits decades apart, residuals of rounding, motions of hours, starts outside the limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "profile/state_judge.hpp"

namespace viapoint {
namespace {

using testing::Dice;
using testing::StateProblem;

constexpr int kProblems = 20'000, kMoreProblems = 40'000;

StateProblem one_joint(const AxisState& start, const AxisState& end, const AxisLimits& limits) {
  StateProblem problem;
  problem.start.push_back(start);
  problem.end.push_back(end);
  problem.limits.push_back(limits);
  return problem;
}

void expect_sound(const StateProblem& problem, StateToState& motion) {
  ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits, problem.options),
            MoveStatus::kSolved);
  EXPECT_EQ(testing::judge(problem, motion).beyond(1e-8, 1e-9), "");
}

/// Anywhere from 1e-6 to 1e9, each on its own, and in half of them up to a thousand times as large
/// one way as the other.
AxisLimits limits_over_fifteen_decades(Dice& dice) {
  const auto any = [&] { return dice.log_uniform(1e-6, 1e9); };
  AxisLimits l = AxisLimits::symmetric(any(), any(), any());
  if (dice.one_in(2)) return l;
  const auto other = [&](double limit) { return -limit * dice.log_uniform(1e-3, 1e3); };
  l.velocity_min = other(l.velocity_max);
  l.acceleration_min = other(l.acceleration_max);
  l.jerk_min = other(l.jerk_max);
  return l;
}

TEST(HardProblems, AreSolvedWithLimitsFromAMillionthToABillionForStatesOfAnyKind) {
  StateToState motion;
  for (std::uint64_t seed = 0; seed < kMoreProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const AxisLimits l = limits_over_fifteen_decades(dice);
    AxisState from = testing::random_inside(dice, l), to = testing::random_inside(dice, l);
    if (dice.one_in(2)) from.q = dice.uniform(-10.0, 10.0);
    to.q = from.q + dice.sign() * dice.log_uniform(1e-6, 1e9);
    if (dice.one_in(8)) {
      from.qd *= 3.0;
      from.qdd *= 3.0;
    }
    StateProblem problem = one_joint(from, to, l);
    expect_sound(problem, motion);
    if (HasFailure()) return;
    problem.options.least_duration = motion.duration() * dice.uniform(1.0, 3.0);
    expect_sound(problem, motion);
    if (HasFailure()) return;
  }
}

TEST(HardProblems, AreSolvedWithResidualsOfRoundingInEveryValue) {
  StateToState motion;
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const AxisLimits l = testing::random_limits(dice, 1.0);
    const auto residual = [&] {
      return dice.one_in(3) ? 0.0 : dice.sign() * dice.log_uniform(1e-17, 1e-13);
    };
    const AxisState whole = dice.one_in(2) ? AxisState{} : testing::random_inside(dice, l);
    const auto nearly = [&](double q) {
      return AxisState{q + residual(), whole.qd * (1.0 + residual()) + residual(),
                       whole.qdd * (1.0 + residual()) + residual(), 0.0};
    };
    // To the next place of the same rates, or back to where it is.
    const bool stays = dice.one_in(2);
    const AxisState from = nearly(0.0), to = nearly(stays ? 0.0 : dice.uniform(-1.0, 1.0));
    if (!testing::is_inside(to, l)) continue;
    const StateProblem problem = one_joint(from, to, l);
    ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits), MoveStatus::kSolved);
    const testing::StateFaults faults = testing::judge(problem, motion);
    // Where nothing has to move, what is missing is smaller than any motion: all but its size.
    if (stays) {
      EXPECT_LE(faults.velocity_limit, 1e-9);
      EXPECT_LE(faults.acceleration_limit, 1e-9);
      EXPECT_LE(faults.jerk_limit, 1e-9);
      EXPECT_EQ(motion.axis(0).end.q, to.q);
      if (whole.qd == 0.0 && whole.qdd == 0.0) {
        EXPECT_LT(motion.duration(), 1e-3);
      }
    } else {
      EXPECT_EQ(faults.beyond(1e-8, 1e-9), "");
    }
    if (HasFailure()) return;
  }
}

TEST(HardProblems, AreSolvedOverTenThousandSecondsForStatesOfAnyKind) {
  StateToState motion;
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const AxisLimits l = testing::random_limits(dice, 0.7);
    const AxisState from = testing::random_inside(dice, l);
    AxisState to = testing::random_inside(dice, l);
    const bool up = dice.one_in(2);
    to.q = 2e4 * (up ? l.velocity_max : l.velocity_min);
    expect_sound(one_joint(from, to, l), motion);
    // At full speed but for the time in which that is reached.
    EXPECT_NEAR(motion.duration(), 2e4, 2e3);
    EXPECT_EQ(motion.axis(0).end.q, to.q);
    if (HasFailure()) return;
  }
}

/// The shortest time from (v, a), a within its limits, down to velocity `to` with no acceleration:
/// by trying how hard to brake, with nothing of the solver's formulas.
double braking_time(double v, double a, double to, const AxisLimits& l) {
  const auto after = [&](double peak) {  // velocity, with the acceleration down to −peak and back
    return v - (a * a - peak * peak) / (2.0 * l.jerk_min) - peak * peak / (2.0 * l.jerk_max);
  };
  double gentle = std::max(0.0, -a), hard = -l.acceleration_min;
  double hold = 0.0;
  if (after(hard) > to) {
    gentle = hard;
    hold = (after(hard) - to) / hard;
  }
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (gentle + hard);
    (after(middle) > to ? gentle : hard) = middle;
  }
  return (a + hard) / -l.jerk_min + hold + hard / l.jerk_max;
}

TEST(HardProblems, ComeBackInByTheQuickestWayFromATooHighSpeed) {
  int braked = 0;
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const AxisLimits l = testing::random_limits(dice, 0.7);
    const double v = l.velocity_max * dice.uniform(1.0, 3.0);
    const double a = dice.uniform(l.acceleration_min, l.acceleration_max);
    // Below the limit by itself, as the acceleration goes to zero: that is another problem.
    if (v - a * a / (2.0 * (a > 0.0 ? l.jerk_min : l.jerk_max)) <= l.velocity_max) continue;
    ++braked;
    // So far away that it gets to the limit and cruises there.
    const AxisState to{1e5 * l.velocity_max, 0.0, 0.0, 0.0};
    AxisMove move;
    ASSERT_EQ(quickest_move({0.0, v, a, 0.0}, to, l, move), MoveStatus::kSolved);
    double in = 0.0;
    int i = 0;
    for (; i < move.phases; ++i) {
      const auto& [seconds, from] = move.phase[static_cast<std::size_t>(i)];
      if (from.qd == l.velocity_max && from.qdd == 0.0 && from.qddd == 0.0) break;
      in += seconds;
    }
    ASSERT_LT(i, move.phases) << "never cruises";
    const double least = braking_time(v, a, l.velocity_max, l);
    // A speed that is off by some roundings takes 2 √(H Δv) to mend.
    const double half = 0.5 * (1.0 / l.jerk_max - 1.0 / l.jerk_min);
    const double rounding = 4e-15 * (v + half * a * a);
    EXPECT_NEAR(in, least, 1e-12 * least + 2.0 * std::sqrt(half * rounding));
    if (HasFailure()) return;
  }
  EXPECT_GT(braked, kProblems / 2);
}

TEST(HardProblems, NeverReverseWhereTheSpeedLimitIsLoweredFromAnyStateThatMovesOn) {
  int checked = 0;
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    AxisLimits l = testing::random_limits(dice, 0.7);
    AxisState from = testing::random_inside(dice, l);
    from.qd = std::abs(from.qd);
    if (!testing::is_inside(from, l)) continue;
    // Stopping at once must not turn back either.
    if (from.qdd < 0.0 && from.qd < from.qdd * from.qdd / (2.0 * l.jerk_max)) continue;
    l.velocity_max *= dice.log_uniform(1e-3, 1.0);
    AxisMove stop, move;
    ASSERT_EQ(quickest_velocity_change(from, {}, l, stop), MoveStatus::kSolved);
    const AxisState to{stop.end.q + dice.log_uniform(1e-3, 1e3), 0.0, 0.0, 0.0};
    ASSERT_EQ(quickest_move(from, to, l, move), MoveStatus::kSolved);
    ++checked;
    double q = from.q;
    for (int i = 0; i < move.phases; ++i) {
      const auto& [seconds, begin] = move.phase[static_cast<std::size_t>(i)];
      const double peak = begin.qddd != 0.0 ? -begin.qdd / begin.qddd : 0.0;
      for (const double t : {0.0, std::clamp(peak, 0.0, seconds), seconds}) {
        EXPECT_GE(begin.qd + t * (begin.qdd + 0.5 * begin.qddd * t), -1e-12 * (1.0 + from.qd));
      }
      EXPECT_GE(begin.q, q - 1e-12 * (1.0 + std::abs(q)));
      q = begin.q;
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(checked, kProblems / 2);
}

}  // namespace
}  // namespace viapoint
