// The first of the problems that tools/bench runs by the million.
#include <gtest/gtest.h>

#include "problem_count.hpp"
#include "profile/state_judge.hpp"

namespace viapoint {
namespace {

TEST(StateToState, SolvesTheFirstHundredThousandOfTheSweepAndEveryMotionIsSound) {
  StateToState motion;
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(100'000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const testing::StateProblem problem = testing::state_problem(seed, 7, 3.0);
    ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits, problem.options),
              MoveStatus::kSolved);
    const testing::StateFaults faults = testing::judge(problem, motion);
    ASSERT_EQ(faults.beyond(1e-8, 1e-9), "");
  }
}

// Where one direction may be ten million times as fast as the other, the slow limit comes near the
// rounding of the fast speed: a few motions are beyond a billionth of that limit, and no more.
TEST(StateToState, KeepsSlowLimitsBesideVeryFastOnesAllButAlways) {
  StateToState motion;
  int beyond = 0;
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(10'000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const testing::StateProblem problem = testing::state_problem(seed, 7, 4.0);
    ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits, problem.options),
              MoveStatus::kSolved);
    const testing::StateFaults faults = testing::judge(problem, motion);
    ASSERT_EQ(faults.beyond(1e-8, 1e-7), "");
    if (!faults.beyond(1e-8, 1e-9).empty()) ++beyond;
  }
  EXPECT_LE(beyond, 20);
}

// What the sweep is worth: the judge sees a millionth of a limit, of an end and of a cycle.
TEST(StateToState, IsJudgedByAJudgeWhoSeesAMillionth) {
  int over_limits = 0, beside_end = 0, moving = 0;
  StateToState motion;
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(200); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const testing::StateProblem problem = testing::state_problem(seed, 1, 1.0);
    ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits, problem.options),
              MoveStatus::kSolved);
    if (motion.duration() == 0.0) continue;
    ++moving;
    testing::StateProblem other = problem;
    AxisLimits& l = other.limits[0];
    for (double* limit : {&l.velocity_min, &l.velocity_max, &l.acceleration_min,
                          &l.acceleration_max, &l.jerk_min, &l.jerk_max}) {
      *limit *= 1.0 - 1e-6;
    }
    if (!testing::judge(other, motion).beyond(1e-8, 1e-9).empty()) ++over_limits;
    other = problem;
    other.end[0].q += 1e-6 * (other.end[0].q - other.start[0].q);
    if (!testing::judge(other, motion).beyond(1e-8, 1e-9).empty()) ++beside_end;
    other = problem;
    other.options.cycle = motion.duration() / (10.0 + 1e-6);
    if (problem.options.synchronization != Synchronization::kNone) {
      EXPECT_NE(testing::judge(other, motion).beyond(1e-8, 1e-9), "");
    }
  }
  EXPECT_GT(moving, problems(190));
  EXPECT_GT(over_limits, moving / 2);  // those slowed down to a duration have room
  EXPECT_GT(beside_end, moving / 2);   // some ends are much nearer than the motion is long
}

}  // namespace
}  // namespace viapoint
