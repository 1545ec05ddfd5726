// Stop, pause and override: how fast a motion runs, and how soon that is as it was asked for.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "problem_count.hpp"
#include "realtime/random_motion.hpp"
#include "realtime/rate_path.hpp"
#include "realtime/ticking.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

constexpr unsigned kMotions = problems(2000U);

bool over(RunState state) { return state == RunState::kFinished || state == RunState::kStopped; }

/// One joint over so many rad: long phases at each limit.
Motion long_move(double velocity, double acceleration, double jerk, double way = 20.0) {
  Motion motion;
  motion.limits = even_limits(1, velocity, acceleration, jerk);
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(1), JointVector::Constant(1, way), motion.limits, 0);
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

TEST(InterpolatorRate, StopsFromAnywhereOnThePath) {
  int stopped = 0;
  for (unsigned seed = 0; seed < kMotions; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    const double share = std::uniform_real_distribution<double>(0.0, 1.1)(random);
    Interpolator interpolator = start(motion);
    if (seed % 3 == 0) interpolator.set_override(0.4);
    std::vector<LogRecord> log;
    while (interpolator.active()) {
      if (interpolator.nominal_time() >= share * motion.trajectory.duration()) {
        interpolator.wish(Wish::kStop);
        interpolator.wish(Wish::kRun);  // too late: a stop is final
      }
      log.push_back(tick(interpolator));
      ASSERT_EQ(log.back().q, motion.trajectory.at(log.back().nominal_time).q);
      ASSERT_LT(log.size(), 20000U);
    }
    ASSERT_TRUE(over(interpolator.state()));
    if (interpolator.state() == RunState::kStopped) {
      ++stopped;
      ASSERT_TRUE(log.back().qd.isZero(0.0));
      ASSERT_TRUE(log.back().qdd.isZero(0.0));
      ASSERT_LT(log.back().nominal_time, motion.trajectory.duration());
    }
    ASSERT_LE(worst_shares(motion, log, kSeconds, 10).worst(), 1.0 + 1e-6);
    const LogRecord after = tick(interpolator);
    ASSERT_EQ(after.q, log.back().q);
  }
  EXPECT_GT(stopped, static_cast<int>(kMotions / 2));
}

TEST(InterpolatorRate, StopsFromFullSpeedAlmostAsFastAsAJointCan) {
  struct Case {
    double velocity, acceleration, jerk, quickest;
  };
  for (const Case& c : {Case{2.0, 20.0, 200.0, 0.2}, Case{2.0, 4.0, 10.0, 0.9},
                        Case{3.0, 30.0, 100.0, 2.0 * std::sqrt(0.03)}}) {
    const Motion motion = long_move(c.velocity, c.acceleration, c.jerk);
    Interpolator interpolator = start(motion);
    while (interpolator.nominal_time() < 0.5 * motion.trajectory.duration()) {
      static_cast<void>(tick(interpolator));
    }
    interpolator.wish(Wish::kStop);
    int cycles = 0;
    for (; interpolator.active(); ++cycles) static_cast<void>(tick(interpolator));
    EXPECT_EQ(interpolator.state(), RunState::kStopped);
    EXPECT_LE((cycles - 1) * kSeconds, c.quickest + 3 * kSeconds);
  }
}

/// Along a straight line at a constant speed the shortest stop is known: it is that of one joint,
/// from v to rest, with a trapezoid of deceleration, or a triangle (Biagiotti & Melchiorri 2008).
TEST(InterpolatorRate, StopsFromAConstantSpeedInATenthMoreThanTheShortestTime) {
  for (unsigned seed = 0; seed < kMotions / 4; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const double v = std::exp(std::log(0.2) + std::log(20.0) * unit(random));
    const double a = v * std::exp(std::log(2.0) + std::log(20.0) * unit(random));
    const double j = a * std::exp(std::log(2.0) + std::log(200.0) * unit(random));
    const double share = 0.2 + 0.8 * unit(random);
    const Motion motion = long_move(v, a, j, 3.0 * v * (v / a + a / j));
    Interpolator interpolator = start(motion);
    interpolator.set_override(share);
    while (interpolator.nominal_time() < 0.5 * motion.trajectory.duration()) {
      static_cast<void>(tick(interpolator));
    }
    interpolator.wish(Wish::kStop);
    int cycles = -1;  // the first one is still at full speed
    for (; interpolator.active(); ++cycles) static_cast<void>(tick(interpolator));
    ASSERT_EQ(interpolator.state(), RunState::kStopped);
    const double speed = share * v;
    const double shortest = speed * j >= a * a ? speed / a + a / j : 2.0 * std::sqrt(speed / j);
    ASSERT_LE(cycles * kSeconds, 1.1 * shortest + kSeconds);
  }
}

TEST(InterpolatorRate, OverrideGoesDownToOnePercentInStepsOfOneInMotion) {
  std::mt19937 random(7);
  Motion motion = random_motion(random);
  while (motion.trajectory.duration() < 2.0) motion = random_motion(random);
  Interpolator interpolator = start(motion);
  std::vector<LogRecord> log;
  const auto settle = [&](int percent) {
    interpolator.set_override(0.01 * percent);
    for (int k = 0; k < 500 && interpolator.rate() != 0.01 * percent; ++k) {
      log.push_back(tick(interpolator));
    }
    EXPECT_EQ(interpolator.rate(), 0.01 * percent);
    EXPECT_EQ(interpolator.state(), RunState::kRunning);
  };
  settle(30);
  for (int percent = 29; percent >= 1; --percent) settle(percent);
  for (int percent = 2; percent <= 20; ++percent) settle(percent);
  for (const LogRecord& record : log) {
    ASSERT_EQ(record.q, motion.trajectory.at(record.nominal_time).q);
  }
  EXPECT_LE(worst_shares(motion, log, kSeconds, 10).worst(), 1.0 + 1e-6);
}

TEST(InterpolatorRate, OverrideSettlesExactlyOnWhatWasAskedFor) {
  const Motion motion = long_move(2.0, 20.0, 200.0);
  Interpolator interpolator = start(motion);
  for (const double share : {0.5, 0.25, 0.9, 1.0, 0.1, 1.0}) {
    interpolator.set_override(share);
    for (int k = 0; k < 300; ++k) static_cast<void>(tick(interpolator));
    const LogRecord record = tick(interpolator);
    EXPECT_EQ(record.rate, share);
    EXPECT_EQ(record.qdd[0], 0.0);
    EXPECT_EQ(record.state, RunState::kRunning);
  }
}

TEST(InterpolatorRate, PauseRestsAndResumeGoesOnFromThere) {
  const Motion motion = long_move(2.0, 20.0, 200.0);
  Interpolator interpolator = start(motion);
  for (int k = 0; k < problems(1000); ++k) static_cast<void>(tick(interpolator));
  interpolator.wish(Wish::kPause);
  EXPECT_EQ(tick(interpolator).state, RunState::kPausing);
  for (int k = 0; k < 200; ++k) static_cast<void>(tick(interpolator));
  const LogRecord paused = tick(interpolator);
  EXPECT_EQ(paused.state, RunState::kPaused);
  EXPECT_EQ(paused.qd[0], 0.0);
  interpolator.wish(Wish::kRun);
  const LogRecord resumed = tick(interpolator);
  EXPECT_EQ(resumed.state, RunState::kRunning);
  EXPECT_EQ(resumed.q, paused.q);
  while (interpolator.active()) static_cast<void>(tick(interpolator));
  EXPECT_EQ(interpolator.state(), RunState::kFinished);
}

TEST(InterpolatorRate, StopsInTimeWhateverTheOverride) {
  const Motion motion = long_move(2.0, 10.0, 100.0);
  for (const double share : {5e-324, 1e-300, 1e-20, 1e-10, 9e-7, 1e-6, 2e-6, 1e-3}) {
    SCOPED_TRACE(share);
    Interpolator interpolator = start(motion);
    for (int k = 0; k < 200; ++k) (void)tick(interpolator);
    interpolator.set_override(share);
    for (int k = 0; k < 1000; ++k) (void)tick(interpolator);  // settled there
    interpolator.wish(Wish::kStop);
    int cycles = 0;
    while (!over(tick(interpolator).state) && cycles < 1000) ++cycles;
    EXPECT_LT(cycles, 20);
  }
}

TEST(InterpolatorRate, OverrideOfZeroActsAsAPause) {
  const Motion motion = long_move(2.0, 20.0, 200.0);
  Interpolator interpolator(motion.limits, kCycle, JointVector::Zero(1));
  interpolator.set_override(0.0);
  interpolator.begin(motion.trajectory);
  for (int k = 0; k < 20; ++k) {
    const LogRecord record = tick(interpolator);
    EXPECT_EQ(record.state, RunState::kPaused);
    EXPECT_EQ(record.nominal_time, 0.0);
  }
  interpolator.set_override(1.0);
  while (interpolator.active()) static_cast<void>(tick(interpolator));
  EXPECT_EQ(interpolator.state(), RunState::kFinished);
}

}  // namespace
}  // namespace viapoint
