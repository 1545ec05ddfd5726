// Motions of hours, in which short phases come late: the clock's rounding must not get into them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "profile/state_judge.hpp"

namespace viapoint {
namespace {

using testing::Cubic;
using testing::Dice;

constexpr int kProblems = 20'000;

/// By how much the rates of phases do not meet, as shares of their limits.
struct Gaps {
  double velocity = 0.0, acceleration = 0.0;
};

Gaps gaps_of(const AxisState& start, const AxisState& end, const AxisLimits& l,
             const AxisMove& move) {
  const double speed = std::max(l.velocity_max, -l.velocity_min);
  const double push = std::max(l.acceleration_max, -l.acceleration_min);
  Gaps worst;
  Cubic before(start);
  const auto meet = [&](const Cubic& next) {
    const double v = static_cast<double>(std::abs(next.qd - before.qd)) / speed;
    const double a = static_cast<double>(std::abs(next.qdd - before.qdd)) / push;
    worst = {std::max(worst.velocity, v), std::max(worst.acceleration, a)};
  };
  for (int i = 0; i < move.phases; ++i) {
    const auto& [seconds, from] = move.phase[static_cast<std::size_t>(i)];
    meet(Cubic(from));
    before = Cubic(from).after(seconds);
  }
  meet(Cubic(end));
  return worst;
}

TEST(LongMotion, KeepsTheDigitsOfItsLatePhases) {
  int long_ones = 0;
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    testing::StateProblem problem;
    const AxisLimits l = testing::random_limits(dice, 1.0);
    problem.start.push_back(testing::random_inside(dice, l));
    problem.end.push_back(testing::random_inside(dice, l));
    problem.end[0].q = dice.sign() * dice.log_uniform(1e3, 1e6);
    problem.limits.push_back(l);
    StateToState motion;
    ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits), MoveStatus::kSolved);
    problem.options.least_duration = motion.duration() * dice.uniform(1.0, 2.0);
    ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits, problem.options),
              MoveStatus::kSolved);
    EXPECT_EQ(testing::judge(problem, motion).beyond(1e-12, 1e-12), "");
    if (motion.duration() > 1e4) ++long_ones;
    const Gaps gaps = gaps_of(problem.start[0], problem.end[0], l, motion.axis(0));
    EXPECT_LE(gaps.velocity, 1e-13);
    EXPECT_LE(gaps.acceleration, 1e-13);
    if (HasFailure()) return;
  }
  EXPECT_GT(long_ones, kProblems / 4);
}

}  // namespace
}  // namespace viapoint
