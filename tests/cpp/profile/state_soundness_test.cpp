// What Python is refused: what is unsound, and nothing that the judge passes.
#include "state_soundness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "problem_count.hpp"
#include "profile/state_judge.hpp"

namespace viapoint {
namespace {

TEST(StateSoundness, HoldsOfEverythingThatTheJudgePasses) {
  StateToState motion;
  for (const std::size_t joints : {std::size_t{2}, std::size_t{7}}) {
    for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(15'000); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", joints " + std::to_string(joints));
      const testing::StateProblem problem = testing::state_problem(seed, joints, 3.0);
      ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits, problem.options),
                MoveStatus::kSolved);
      for (std::size_t i = 0; i < joints; ++i) {
        ASSERT_TRUE(
            python::is_sound(motion.axis(static_cast<int>(i)), problem.start[i], problem.limits[i]))
            << "joint " << i;
      }
    }
  }
}

// Two joints near 1 rad that wait for a third: the clock of 1e7 s ticks in nanoseconds.
TEST(StateSoundness, HoldsOfJointsThatWaitForMonths) {
  testing::Dice dice(1);
  StateToState motion;
  const AxisLimits limits = AxisLimits::symmetric(1.0, 5.0, 50.0);
  for (int problem = 0; problem < problems(2'000); ++problem) {
    SCOPED_TRACE("problem " + std::to_string(problem));
    const AxisState start{0.0, dice.uniform(-0.9, 0.9), dice.uniform(-2.0, 2.0), 0.0};
    const AxisState end{dice.uniform(-2.0, 2.0), dice.uniform(-0.9, 0.9), 0.0, 0.0};
    StateToStateOptions options;
    options.least_duration = std::pow(10.0, dice.uniform(3.0, 9.0));
    ASSERT_EQ(motion.plan({&start, 1}, {&end, 1}, {&limits, 1}, options), MoveStatus::kSolved);
    ASSERT_TRUE(python::is_sound(motion.axis(0), start, limits));
  }
}

TEST(StateSoundness, IsDeniedToEveryPlantedFault) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int planted = 0;
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(2'000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    testing::Dice dice(seed);
    const AxisLimits l = testing::random_limits(dice, 1.0);
    const AxisState start = testing::random_inside(dice, l);
    const AxisState end{start.q + dice.sign() * dice.log_uniform(1e-3, 1e3), 0.0, 0.0, 0.0};
    AxisMove move;
    ASSERT_EQ(quickest_move(start, end, l, move), MoveStatus::kSolved);
    ASSERT_TRUE(python::is_sound(move, start, l));
    const AxisMove::Extent extent = move.extent();
    const double size = extent.high - extent.low;
    const auto at = static_cast<std::size_t>(dice.roll() % static_cast<std::uint64_t>(move.phases));
    const std::function<void(AxisMove&)> faults[] = {
        [&](AxisMove& m) { m.phase[at].from.q += 1e-6 * size; },
        [&](AxisMove& m) { m.phase[at].from.qd += 1e-6 * (l.velocity_max - l.velocity_min); },
        [&](AxisMove& m) {
          m.phase[at].from.qdd += 1e-6 * (l.acceleration_max - l.acceleration_min);
        },
        [&](AxisMove& m) { m.phase[at].from.qddd = 1.000001 * l.jerk_max; },
        [&](AxisMove& m) { m.phase[at].from.qddd = 1.000001 * l.jerk_min; },
        [&](AxisMove& m) { m.phase[at].duration = nan; },
        [&](AxisMove& m) { m.phase[at].from.qd = nan; },
        [&](AxisMove& m) { m.phase[at].duration *= 2.0; },
        [&](AxisMove& m) { m.end.q += 1e-6 * size; },
        [&](AxisMove& m) { m.total = nan; },
    };
    for (std::size_t i = 0; i < std::size(faults); ++i) {
      AxisMove other = move;
      faults[i](other);
      EXPECT_FALSE(python::is_sound(other, start, l)) << "fault " << i << " in phase " << at;
      ++planted;
    }
    AxisState elsewhere = start;
    elsewhere.q += 1e-6 * size;
    EXPECT_FALSE(python::is_sound(move, elsewhere, l));
  }
  EXPECT_EQ(planted, problems(20'000));
}

TEST(StateSoundness, SeesAMillionthOverALimitThatIsSmallBesideTheOther) {
  AxisMove move;
  const AxisState end{-10.0, 0.0, 0.0, 0.0};
  AxisLimits l{-1e-3, 1e3, -1e3, 1e3, -1e3, 1e3};
  ASSERT_EQ(quickest_move({}, end, l, move), MoveStatus::kSolved);
  EXPECT_TRUE(python::is_sound(move, {}, l));
  l.velocity_min *= 1.0 - 1e-6;
  EXPECT_FALSE(python::is_sound(move, {}, l));
}

}  // namespace
}  // namespace viapoint
