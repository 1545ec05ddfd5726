#include "viapoint/realtime/jog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "problem_count.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "realtime/random_motion.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr double kSeconds = 0.002;
constexpr double kNone = std::numeric_limits<double>::infinity();
/// Cycles that a wish counts for: 250 ms.
constexpr int kLease = 126;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

JointLimits plain_limits(int joints) {
  JointLimits limits;
  limits.position_min = JointVector::Constant(joints, -1.0);
  limits.position_max = JointVector::Constant(joints, 1.0);
  limits.velocity = JointVector::Constant(joints, 1.0);
  limits.acceleration = JointVector::Constant(joints, 5.0);
  limits.jerk = JointVector::Constant(joints, 50.0);
  limits.coupling.resize(0, joints);
  limits.coupling_lower.resize(0);
  limits.coupling_upper.resize(0);
  return limits;
}

/// Joints with and without position limits, and, every other time, coupled ones.
JointLimits random_limits(std::mt19937& random) {
  const int joints = 1 + static_cast<int>(random() % 7);
  JointLimits limits = plain_limits(joints);
  for (int i = 0; i < joints; ++i) {
    limits.velocity[i] = uniform(random, 0.3, 4.0);
    limits.acceleration[i] = uniform(random, 1.0, 40.0);
    limits.jerk[i] = uniform(random, 10.0, 2000.0);
    limits.position_max[i] = random() % 4 == 0 ? kNone : uniform(random, 0.01, 1.0);
    limits.position_min[i] = random() % 4 == 0 ? -kNone : uniform(random, -1.0, -0.01);
  }
  const int rows = random() % 2 == 0 ? static_cast<int>(random() % 3) : 0;
  limits.coupling.resize(rows, joints);
  limits.coupling_lower.resize(rows);
  limits.coupling_upper.resize(rows);
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < joints; ++i) limits.coupling(row, i) = uniform(random, -1.0, 1.0);
    limits.coupling_lower[row] = uniform(random, -0.5, -0.05);
    limits.coupling_upper[row] = uniform(random, 0.05, 0.5);
  }
  return limits;
}

/// Bounds that any motion within the limits keeps from one cycle to the next (Taylor's remainder
/// with the largest jerk), and the limits themselves.
::testing::AssertionResult is_legal(const JointLimits& limits, const Setpoint& from,
                                    const Setpoint& to) {
  constexpr double kRounding = 1e-9;
  const double c = kSeconds;
  for (int i = 0; i < limits.joints(); ++i) {
    const double jerk = limits.jerk[i] * (1.0 + kRounding);
    const double a = to.qdd[i] - from.qdd[i];
    const double v = to.qd[i] - from.qd[i] - c * from.qdd[i];
    const double q = to.q[i] - from.q[i] - c * (from.qd[i] + c * from.qdd[i] / 2.0);
    const bool legal = std::abs(to.qd[i]) <= limits.velocity[i] * (1.0 + kRounding) &&
                       std::abs(to.qdd[i]) <= limits.acceleration[i] * (1.0 + kRounding) &&
                       std::abs(to.qddd[i]) <= jerk && std::abs(a) <= jerk * c + kRounding &&
                       std::abs(v) <= jerk * c * c / 2.0 + 1e-12 &&
                       std::abs(q) <= jerk * c * c * c / 6.0 + 1e-14 &&
                       to.q[i] <= limits.position_max[i] + kRounding &&
                       to.q[i] >= limits.position_min[i] - kRounding;
    if (legal) continue;
    return ::testing::AssertionFailure()
           << "joint " << i << ": q " << to.q[i] << " qd " << to.qd[i] << " qdd " << to.qdd[i]
           << " qddd " << to.qddd[i] << ", off a smooth course by " << q << ", " << v << ", " << a;
  }
  for (int row = 0; row < limits.couplings(); ++row) {
    const double sum = limits.coupling.row(row).dot(to.q);
    if (sum <= limits.coupling_upper[row] + kRounding &&
        sum >= limits.coupling_lower[row] - kRounding) {
      continue;
    }
    return ::testing::AssertionFailure() << "coupled limit " << row << ": " << sum;
  }
  return ::testing::AssertionSuccess();
}

JointVector random_wish(std::mt19937& random, const JointLimits& limits) {
  JointVector wish(limits.joints());
  for (int i = 0; i < limits.joints(); ++i) {
    const double most = limits.velocity[i];
    wish[i] = random() % 3 == 0 ? 0.0 : random() % 3 == 0 ? most : uniform(random, -most, most);
  }
  return wish;
}

TEST(Jog, KeepsEveryLimitWhateverIsWished) {
  int position_blocks = 0, coupling_blocks = 0;
  for (unsigned seed = 0; seed < problems(3000U); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const JointLimits limits = random_limits(random);
    const JointVector start = JointVector::Zero(limits.joints());
    Interpolator interpolator(limits, kCycle, start);
    Setpoint last, now;
    interpolator.tick(last);
    int next = 0;
    // Joystick noise in every cycle, or a new wish now and then, also later than the lease.
    const bool is_noisy = seed % 4 == 0;
    for (int cycle = 0; cycle < 400; ++cycle) {
      if (cycle >= next) {
        interpolator.jog(random() % 8 == 0 ? start : random_wish(random, limits));
        next = cycle + (is_noisy ? 1 : 1 + static_cast<int>(random() % 160));
      }
      interpolator.tick(now);
      ASSERT_TRUE(is_legal(limits, last, now)) << "cycle " << cycle;
      last = now;
    }
    if (interpolator.jog_block().kind == JogBlock::Kind::kPositionLimit) ++position_blocks;
    if (interpolator.jog_block().kind == JogBlock::Kind::kCouplingLimit) ++coupling_blocks;
    // Silence: at rest after the lease and the longest stop, v/a + a/j.
    double stop = 0.0;
    for (int i = 0; i < limits.joints(); ++i) {
      stop = std::max(stop, limits.velocity[i] / limits.acceleration[i] +
                                2.0 * limits.acceleration[i] / limits.jerk[i]);
    }
    const int longest = kLease + static_cast<int>(stop / kSeconds) + 2;
    for (int cycle = 0; cycle < longest; ++cycle) {
      interpolator.tick(now);
      ASSERT_TRUE(is_legal(limits, last, now)) << "after the wish, cycle " << cycle;
      last = now;
    }
    EXPECT_EQ(interpolator.state(), RunState::kIdle);
    EXPECT_FALSE(interpolator.jogging());
    EXPECT_TRUE(now.qd.isZero(0.0) && now.qdd.isZero(0.0) && now.qddd.isZero(0.0));
    if (HasFailure()) return;
  }
  EXPECT_GT(position_blocks, problems(200));
  EXPECT_GT(coupling_blocks, problems(200));
}

/// Ticks until the jog has ended, or `most` cycles; the last setpoint.
Setpoint tick(Interpolator& interpolator, int most) {
  Setpoint setpoint;
  interpolator.tick(setpoint);
  for (int i = 1; i < most && interpolator.jogging(); ++i) interpolator.tick(setpoint);
  return setpoint;
}

TEST(Jog, ReachesTheWishedVelocityAndHoldsIt) {
  JointLimits limits = plain_limits(2);
  limits.position_max[0] = kNone;
  Interpolator interpolator(limits, kCycle, JointVector::Zero(2));
  Setpoint setpoint;
  for (int cycle = 0; cycle < 2000; ++cycle) {
    interpolator.jog(JointVector{{0.7, -0.1}});
    EXPECT_EQ(interpolator.tick(setpoint), RunState::kJogging);
    if (cycle <= 200) continue;
    EXPECT_NEAR(setpoint.qd[0], 0.7, 1e-12);
    EXPECT_NEAR(setpoint.qd[1], -0.1, 1e-12);
  }
  // To 0.7 at jerk 50 and acceleration 5 takes 0.24 s, on average at half of it.
  EXPECT_NEAR(setpoint.q[0], 0.7 * (1999 * kSeconds - 0.12), 1e-9);
}

TEST(Jog, EndsByItselfWhenTheCallsStop) {
  Interpolator interpolator(plain_limits(1), kCycle, JointVector::Zero(1));
  interpolator.jog(JointVector{{0.2}});
  Setpoint setpoint;
  int slowing = 0;
  for (; slowing < 1000; ++slowing) {
    interpolator.tick(setpoint);
    if (setpoint.qdd[0] < 0.0) break;
  }
  // Braking begins with the cycle after the lease, and shows one cycle later.
  EXPECT_NEAR(slowing * kSeconds, 0.25, 3.0 * kSeconds);
  tick(interpolator, 1000);
  EXPECT_EQ(interpolator.state(), RunState::kIdle);
  const Setpoint rest = tick(interpolator, 1);
  EXPECT_EQ(rest.qd[0], 0.0);
  EXPECT_GT(rest.q[0], 0.0);
}

TEST(Jog, StopsAtOnceWhenZeroIsWished) {
  Interpolator interpolator(plain_limits(1), kCycle, JointVector::Zero(1));
  Setpoint setpoint;
  interpolator.jog(JointVector{{1.0}});
  for (int i = 0; i < 100; ++i) interpolator.tick(setpoint);
  interpolator.jog(JointVector{{0.0}});
  int cycles = 0;
  while (interpolator.jogging()) {
    interpolator.tick(setpoint);
    ++cycles;
  }
  EXPECT_LE(cycles * kSeconds, 0.1 + 0.3 + 0.005);  // a is 5 at most: a/j more than v/a
  EXPECT_EQ(interpolator.state(), RunState::kIdle);
}

TEST(Jog, StopsAtThePositionLimitBySelfAndLeavesIt) {
  Interpolator interpolator(plain_limits(2), kCycle, JointVector::Zero(2));
  Setpoint setpoint;
  for (int cycle = 0; cycle < 2000; ++cycle) {
    interpolator.jog(JointVector{{1.0, 0.0}});
    interpolator.tick(setpoint);
  }
  EXPECT_EQ(setpoint.q[0], 1.0);
  EXPECT_EQ(setpoint.qd[0], 0.0);
  EXPECT_EQ(interpolator.state(), RunState::kJogging);
  EXPECT_EQ(interpolator.jog_block().kind, JogBlock::Kind::kPositionLimit);
  EXPECT_EQ(interpolator.jog_block().index, 0);
  for (int cycle = 0; cycle < 100; ++cycle) {
    interpolator.jog(JointVector{{-1.0, 0.0}});
    interpolator.tick(setpoint);
  }
  EXPECT_LT(setpoint.q[0], 0.95);
  EXPECT_EQ(interpolator.jog_block().kind, JogBlock::Kind::kNone);
}

TEST(Jog, StopsBeforeACoupledLimitAndLeavesIt) {
  JointLimits limits = plain_limits(2);
  limits.coupling = CouplingMatrix{{1.0, 1.0}};
  limits.coupling_lower = CouplingVector{{-0.5}};
  limits.coupling_upper = CouplingVector{{0.5}};
  Interpolator interpolator(limits, kCycle, JointVector::Zero(2));
  Setpoint setpoint;
  for (int cycle = 0; cycle < 2000; ++cycle) {
    interpolator.jog(JointVector{{0.5, 0.3}});
    interpolator.tick(setpoint);
    ASSERT_LE(setpoint.q.sum(), 0.5);
  }
  EXPECT_GT(setpoint.q.sum(), 0.495);
  EXPECT_TRUE(setpoint.qd.isZero(0.0));
  EXPECT_EQ(interpolator.jog_block().kind, JogBlock::Kind::kCouplingLimit);
  EXPECT_EQ(interpolator.jog_block().index, 0);
  for (int cycle = 0; cycle < 300; ++cycle) {
    interpolator.jog(JointVector{{-0.5, 0.0}});
    interpolator.tick(setpoint);
  }
  EXPECT_LT(setpoint.q.sum(), 0.4);
}

TEST(Jog, ComesInFromOutsideAndGoesNoFartherOut) {
  Interpolator interpolator(plain_limits(1), kCycle, JointVector::Constant(1, 1.2));
  Setpoint setpoint;
  for (int cycle = 0; cycle < 500; ++cycle) {
    interpolator.jog(JointVector{{0.5}});
    interpolator.tick(setpoint);
    ASSERT_EQ(setpoint.q[0], 1.2);
  }
  for (int cycle = 0; cycle < 1000; ++cycle) {
    interpolator.jog(JointVector{{-0.5}});
    interpolator.tick(setpoint);
    ASSERT_LE(setpoint.q[0], 1.2);
  }
  EXPECT_LT(setpoint.q[0], 0.9);
}

TEST(Jog, IsIgnoredWhileAMotionRunsAndAfterAFault) {
  std::mt19937 random(1);
  const Motion motion = random_motion(random);
  const int joints = motion.limits.joints();
  Interpolator interpolator(motion.limits, kCycle, motion.trajectory.at(0.0).q);
  interpolator.begin(motion.trajectory);
  interpolator.jog(motion.limits.velocity);
  EXPECT_FALSE(interpolator.jogging());
  Setpoint setpoint;
  while (interpolator.active()) interpolator.tick(setpoint);
  EXPECT_EQ(interpolator.state(), RunState::kFinished);
  interpolator.jog(0.1 * motion.limits.velocity);
  EXPECT_EQ(interpolator.tick(setpoint), RunState::kJogging);
  interpolator.abandon();
  EXPECT_FALSE(interpolator.jogging());
  interpolator.jog(JointVector::Constant(joints, 0.1));
  EXPECT_EQ(interpolator.tick(setpoint), RunState::kFault);
}

TEST(Jog, LeavesTheHeapAlone) {
  std::mt19937 random(7);
  JointLimits limits = random_limits(random);
  Interpolator interpolator(limits, kCycle, JointVector::Zero(limits.joints()));
  Setpoint setpoint;
  interpolator.tick(setpoint);
  const JointVector wish = 0.5 * limits.velocity;
  const NoAllocationScope scope;
  for (int cycle = 0; cycle < 1000; ++cycle) {
    if (cycle % 100 == 0) interpolator.jog(cycle % 200 == 0 ? wish : -wish);
    interpolator.tick(setpoint);
  }
  EXPECT_EQ(scope.calls(), 0u);
}

}  // namespace
}  // namespace viapoint
