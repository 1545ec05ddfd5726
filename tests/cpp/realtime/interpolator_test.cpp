#include "viapoint/realtime/interpolator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "problem_count.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "realtime/random_motion.hpp"
#include "realtime/rate_path.hpp"
#include "realtime/ticking.hpp"

namespace viapoint {
namespace {

constexpr unsigned kMotions = problems(2000U);

TEST(Interpolator, HoldsPositionUntilAMotionBegins) {
  const JointVector q = JointVector::LinSpaced(3, 0.1, 0.3);
  Interpolator interpolator(even_limits(3, 1.0, 10.0, 100.0), kCycle, q);
  for (int k = 0; k < 5; ++k) {
    const LogRecord record = tick(interpolator);
    EXPECT_EQ(record.q, q);
    EXPECT_EQ(record.qd, JointVector::Zero(3));
    EXPECT_EQ(record.state, RunState::kIdle);
    EXPECT_EQ(record.cycle, static_cast<std::uint64_t>(k));
  }
}

TEST(Interpolator, IsTheTrajectoryAtEachCycleToTheLastBit) {
  for (unsigned seed = 0; seed < problems(500U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    ASSERT_TRUE(motion.trajectory.certificate().holds());
    Interpolator interpolator = start(motion);
    const double duration = motion.trajectory.duration();
    for (std::uint64_t k = 0; interpolator.active(); ++k) {
      const LogRecord record = tick(interpolator);
      const double t = std::min(static_cast<double>(k) * kSeconds, duration);
      if (record.state != RunState::kFinished) {
        ASSERT_EQ(record.nominal_time, t);
        ASSERT_LT(t, duration);
      }
      const JointState expected = motion.trajectory.at(record.nominal_time);
      ASSERT_EQ(record.q, expected.q);
      ASSERT_EQ(record.qd, expected.qd);
      ASSERT_EQ(record.qdd, expected.qdd);
      ASSERT_EQ(record.qddd, expected.qddd);
      ASSERT_EQ(record.rate, 1.0);
    }
    EXPECT_EQ(interpolator.state(), RunState::kFinished);
    EXPECT_EQ(interpolator.nominal_time(), duration);
  }
}

TEST(Interpolator, EndsExactlyOnTheEndPointAndStaysThere) {
  std::mt19937 random(5);
  const Motion motion = curved_motion(random);
  Interpolator interpolator = start(motion);
  LogRecord last;
  std::uint64_t cycles = 0;
  for (; interpolator.active(); ++cycles) last = tick(interpolator);
  const double duration = motion.trajectory.duration();
  EXPECT_EQ(last.q, motion.trajectory.at(duration).q);
  EXPECT_EQ(cycles, static_cast<std::uint64_t>(std::ceil(duration / kSeconds)) + 1);
  const LogRecord after = tick(interpolator);
  EXPECT_EQ(after.q, last.q);
  EXPECT_EQ(after.qd, JointVector::Zero(motion.limits.joints()));
  EXPECT_EQ(after.state, RunState::kFinished);
}

TEST(Interpolator, AMotionOfWholeCyclesTakesThatManyCycles) {
  Motion motion;
  motion.limits = even_limits(2, 1.0, 10.0, 100.0);
  std::vector<TrajectoryPiece> pieces;
  append_wait(pieces, JointVector::Zero(2), 0.1, 0);
  append_wait(pieces, JointVector::Zero(2), 0.2, 1);
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  Interpolator interpolator = start(motion);
  int cycles = 0;
  for (; interpolator.active(); ++cycles) static_cast<void>(tick(interpolator));
  EXPECT_EQ(cycles, 151);
}

TEST(Interpolator, OutputsChangeWithTheFirstSetpointOfTheirPiece) {
  Motion motion;
  motion.limits = even_limits(1, 1.0, 10.0, 100.0);
  std::vector<TrajectoryPiece> pieces;
  for (int i = 0; i < 3; ++i) append_wait(pieces, JointVector::Zero(1), 0.01, i);
  pieces[0].outputs = 1;
  pieces[0].output[0] = {63, true};
  pieces[1].outputs = 2;
  pieces[1].output[0] = {3, true};
  pieces[1].output[1] = {63, false};
  pieces[2].outputs = 1;
  pieces[2].output[0] = {3, false};
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  Interpolator interpolator = start(motion);
  for (int k = 0; interpolator.active(); ++k) {
    const LogRecord record = tick(interpolator);
    const std::uint64_t expected = k < 5 ? std::uint64_t{1} << 63 : k < 10 ? 8U : 0U;
    EXPECT_EQ(record.outputs, expected) << "cycle " << k;
    EXPECT_EQ(record.move, k < 5 ? 0 : k < 10 ? 1 : 2);
  }
}

/// Commands at random moments; the wildest that an operator can do.
void command_at_random(std::mt19937& random, Interpolator& interpolator, double eagerness) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  if (unit(random) >= eagerness) return;
  const double what = unit(random);
  if (what < 0.35) {
    interpolator.set_override(unit(random));
  } else if (what < 0.45) {
    interpolator.set_override(unit(random) < 0.5 ? 0.0 : 1.0);
  } else if (what < 0.65) {
    interpolator.wish(Wish::kPause);
  } else {
    interpolator.wish(Wish::kRun);
  }
}

TEST(Interpolator, RandomCommandsNeverLeaveThePathOrTheLimitsAndTheMotionEnds) {
  double worst = 0.0;
  for (unsigned seed = 0; seed < kMotions; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    Interpolator interpolator = start(motion);
    const double eagerness = std::uniform_real_distribution<double>(0.002, 0.1)(random);
    std::vector<LogRecord> log;
    while (interpolator.active()) {
      ASSERT_LT(log.size(), 20000U);
      if (log.size() < 1500) {
        command_at_random(random, interpolator, eagerness);
      } else if (log.size() == 1500) {
        interpolator.set_override(1.0);
        interpolator.wish(Wish::kRun);
      }
      log.push_back(tick(interpolator));
      const LogRecord& now = log.back();
      ASSERT_EQ(now.q, motion.trajectory.at(now.nominal_time).q);
      ASSERT_GE(now.rate, 0.0);
      ASSERT_LE(now.rate, 1.0);
      if (log.size() > 1) {
        ASSERT_GE(now.nominal_time, log[log.size() - 2].nominal_time);
      }
      ASSERT_EQ(now.state == RunState::kPaused, now.rate == 0.0 && interpolator.active() &&
                                                    now.qdd.isZero(0.0) &&
                                                    now.state != RunState::kRunning);
    }
    ASSERT_EQ(interpolator.state(), RunState::kFinished);
    ASSERT_EQ(log.back().q, motion.trajectory.at(motion.trajectory.duration()).q);
    const Shares shares = worst_shares(motion, log, kSeconds, 20);
    ASSERT_LE(shares.worst(), 1.0 + 1e-6) << "cycle " << shares.cycle;
    worst = std::max(worst, shares.worst());
  }
  EXPECT_GT(worst, 0.999) << "the limits were never reached: the test shows nothing";
}

TEST(Interpolator, KeepsTheLimitsInAThousandSamplesOfEachCycle) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = curved_motion(random);
    Interpolator interpolator = start(motion);
    std::vector<LogRecord> log;
    while (interpolator.active() && log.size() < 400) {
      command_at_random(random, interpolator, 0.05);
      log.push_back(tick(interpolator));
    }
    const Shares shares = worst_shares(motion, log, kSeconds, 1000);
    EXPECT_LE(shares.worst(), 1.0 + 1e-6) << "cycle " << shares.cycle;
  }
}

TEST(Interpolator, SetpointDerivativesAreThoseByRealTime) {
  std::mt19937 random(11);
  const Motion motion = curved_motion(random);
  Interpolator interpolator = start(motion);
  interpolator.set_override(0.8);
  std::vector<LogRecord> log;
  while (interpolator.active()) {
    if (log.size() == 10) interpolator.set_override(0.3);
    log.push_back(tick(interpolator));
  }
  // Over one cycle the velocity is the integral of what the setpoints at its ends say (trapezoid
  // with end correction, error O(h⁴)).
  for (std::size_t k = 1; k + 2 < log.size(); ++k) {
    const LogRecord &a = log[k], &b = log[k + 1];
    for (int i = 0; i < motion.limits.joints(); ++i) {
      const double step =
          0.5 * kSeconds * (a.qd[i] + b.qd[i]) + kSeconds * kSeconds / 12.0 * (a.qdd[i] - b.qdd[i]);
      const double jerk_step = motion.limits.jerk[i] * std::pow(kSeconds, 3);
      ASSERT_NEAR(b.q[i] - a.q[i], step, 0.02 * jerk_step) << "cycle " << k;
    }
  }
}

TEST(Interpolator, RunsOneMotionAfterAnother) {
  Motion motion;
  motion.limits = even_limits(1, 2.0, 20.0, 200.0);
  std::vector<TrajectoryPiece> there, back;
  append_straight(there, JointVector::Zero(1), JointVector::Constant(1, 1.0), motion.limits, 0);
  append_straight(back, JointVector::Constant(1, 1.0), JointVector::Constant(1, -1.0),
                  motion.limits, 0);
  const Trajectory first(there, motion.limits), second(back, motion.limits);
  Interpolator interpolator(motion.limits, kCycle, JointVector::Zero(1));
  for (int round = 0; round < 3; ++round) {
    for (const Trajectory* trajectory : {&first, &second}) {
      interpolator.begin(*trajectory);
      LogRecord last;
      while (interpolator.active()) last = tick(interpolator);
      EXPECT_EQ(last.q, trajectory->at(trajectory->duration()).q);
    }
  }
}

TEST(Interpolator, NeverTouchesTheHeapInAHundredThousandCycles) {
  std::vector<Motion> motions;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    motions.push_back(random_motion(random));
  }
  std::mt19937 random(1);
  std::uint64_t cycles = 0, allocations = 0;
  for (std::size_t round = 0; cycles < 100'000; ++round) {
    const Motion& motion = motions[round % motions.size()];
    Interpolator interpolator(motion.limits, kCycle, motion.trajectory.at(0.0).q);
    Setpoint setpoint;
    const NoAllocationScope scope;
    interpolator.begin(motion.trajectory);
    for (std::uint64_t k = 0; interpolator.active(); ++k, ++cycles) {
      command_at_random(random, interpolator, 0.03);
      if (k > 1000) interpolator.wish(round % 2 == 0 ? Wish::kRun : Wish::kStop);
      if (k > 1000) interpolator.set_override(1.0);
      interpolator.tick(setpoint);
    }
    allocations += scope.calls();
  }
  EXPECT_EQ(allocations, 0U);
}

TEST(NoAllocationScope, CountsWhatHappensInIt) {
  const NoAllocationScope scope;
  const std::vector<double> block(100);
  EXPECT_GE(scope.calls(), 1U);
}

}  // namespace
}  // namespace viapoint
