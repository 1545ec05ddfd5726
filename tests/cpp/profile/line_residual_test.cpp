// Straight lines whose ends are the same place but for the last digits: 0.1 + 0.2 instead of 0.3.
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>

#include "profile/state_judge.hpp"
#include "state_soundness.hpp"

namespace viapoint {
namespace {

constexpr int kProblems = 6'000;
constexpr StateToStateOptions kLine{Synchronization::kLine, 0.0, 0.0};

/// Joints that move along one direction and come back to where they are, or go through it.
testing::StateProblem there_and_back(testing::Dice& dice) {
  testing::StateProblem problem;
  problem.options = kLine;
  const std::size_t joints = 2 + dice.roll() % 5;
  const double v0 = dice.one_in(4) ? 0.0 : dice.sign() * dice.uniform(0.3, 0.8);
  const double v1 = v0 != 0.0 && dice.one_in(2) ? 0.0 : -dice.sign() * dice.uniform(0.3, 0.8);
  const double a0 = dice.one_in(2) ? 0.0 : dice.uniform(-0.5, 0.5);
  for (std::size_t i = 0; i < joints; ++i) {
    const double direction = i == 0 ? 1.0 : (dice.one_in(3) ? 0.0 : dice.uniform(-1.0, 1.0));
    const double q = dice.one_in(3) ? 0.0 : dice.uniform(-3.0, 3.0);
    problem.start.push_back({q, direction * v0, direction * a0, 0.0});
    problem.end.push_back({q, direction * v1, 0.0, 0.0});
    problem.limits.push_back(AxisLimits::symmetric(1.0, dice.uniform(0.8, 2.0), 5.0));
  }
  return problem;
}

TEST(StateToState, TakesNoDirectionFromResidualsOfAPosition) {
  int residuals = 0;
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    testing::Dice dice(seed);
    testing::StateProblem problem = there_and_back(dice);
    StateToState exact, motion;
    ASSERT_EQ(exact.plan(problem.start, problem.end, problem.limits, problem.options),
              MoveStatus::kSolved);
    for (AxisState& end : problem.end) {
      if (dice.one_in(2)) end.q += dice.sign() * dice.log_uniform(1e-18, 1e-12);
    }
    ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits, problem.options),
              MoveStatus::kSolved);
    EXPECT_NEAR(motion.duration(), exact.duration(), 1e-8 * (1.0 + exact.duration()));
    double reach = 0.0;
    for (std::size_t i = 0; i < problem.joints(); ++i) {
      const AxisMove::Extent extent = motion.axis(static_cast<int>(i)).extent();
      reach = std::max(reach, extent.high - extent.low);
    }
    for (std::size_t i = 0; i < problem.joints(); ++i) {
      const AxisMove& move = motion.axis(static_cast<int>(i));
      const AxisState& end = problem.end[i];
      ASSERT_TRUE(python::is_sound(move, problem.start[i], problem.limits[i])) << "joint " << i;
      EXPECT_NEAR(move.end.q, end.q, 1e-8 * reach + 1e-15 * std::abs(end.q));
      EXPECT_EQ(move.end.qd, end.qd);
      if (end.q != problem.start[i].q) ++residuals;
      // Beside the line by no more than that, all the way.
      for (const double share : {0.2, 0.4, 0.6, 0.8}) {
        const double t = share * motion.duration();
        EXPECT_NEAR(move.at(t).q, exact.axis(static_cast<int>(i)).at(t).q, 1e-8 * reach);
      }
    }
  }
  EXPECT_GT(residuals, kProblems);
}

TEST(StateToState, GoesThreeTenthsToTheSumOfOneAndTwo) {
  const AxisState start[] = {{0.3, 0.0, 0.0, 0.0}, {0.5, 0.1, 0.0, 0.0}};
  const AxisState end[] = {{0.1 + 0.2, 0.0, 0.0, 0.0}, {0.5, 0.0, 0.0, 0.0}};
  const AxisLimits limits[] = {AxisLimits::symmetric(1.0, 1.0, 1.0),
                               AxisLimits::symmetric(1.0, 1.0, 1.0)};
  ASSERT_NE(start[0].q, end[0].q);
  StateToState motion;
  ASSERT_EQ(motion.plan(start, end, limits, kLine), MoveStatus::kSolved);
  EXPECT_NEAR(motion.duration(), 1.3017016520692888, 1e-12);
}

TEST(StateToState, StillGoesAShortWayFromRestAndRefusesOneBesideTheVelocity) {
  const AxisLimits limits[] = {AxisLimits::symmetric(1.0, 1.0, 1.0),
                               AxisLimits::symmetric(1.0, 1.0, 1.0)};
  AxisState start[2], end[2];
  StateToState motion;
  for (const double way : {1e-15, 1e-12, 1e-6}) {
    end[0].q = way;
    end[1].q = -0.5 * way;
    ASSERT_EQ(motion.plan(start, end, limits, kLine), MoveStatus::kSolved);
    EXPECT_NEAR(motion.duration(), std::cbrt(32.0 * way), 1e-9 * std::cbrt(32.0 * way));
    EXPECT_EQ(motion.at(motion.duration()).q[1], -0.5 * way);
  }
  start[0].qd = 0.1;
  end[0].q = 0.0;
  end[1].q = 1e-6;
  EXPECT_EQ(motion.plan(start, end, limits, kLine), MoveStatus::kNotParallel);
}

}  // namespace
}  // namespace viapoint
