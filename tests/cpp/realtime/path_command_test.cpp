// Backward, single step, and the way back to a path after a jog.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <vector>

#include "problem_count.hpp"
#include "realtime/random_motion.hpp"
#include "realtime/rate_path.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr double kSeconds = 2e-3;

/// Interpolator and what it has told so far.
class RecordedRun {
 public:
  explicit RecordedRun(const Motion& motion)
      : interpolator(motion.limits, kCycle, motion.trajectory.at(0.0).q) {
    interpolator.begin(motion.trajectory);
  }

  const LogRecord& tick() {
    Setpoint setpoint;
    LogRecord record;
    interpolator.tick(setpoint);
    interpolator.describe(setpoint, record);
    record.cycle = log.size();
    log.push_back(record);
    return log.back();
  }
  void ticks(int count) {
    for (int k = 0; k < count && interpolator.active(); ++k) tick();
  }
  /// Until the arm is in this state, or the motion is over.
  void until(RunState state) {
    for (int k = 0; k < 20'000 && interpolator.active(); ++k) {
      if (tick().state == state) return;
    }
    EXPECT_FALSE(interpolator.active()) << "never " << to_string(state);
  }

  Interpolator interpolator;
  std::vector<LogRecord> log;
};

/// Two joints, three moves with a stop after each, each of which switches an output on.
Motion three_moves() {
  Motion motion;
  motion.limits = even_limits(2, 2.0, 20.0, 200.0);
  std::vector<TrajectoryPiece> pieces;
  JointVector q = JointVector::Zero(2);
  for (int m = 0; m < 3; ++m) {
    JointVector step(2);
    step << 1.0, m == 1 ? -0.5 : 0.7;
    const std::size_t first = pieces.size();
    append_straight(pieces, q, step, motion.limits, m);
    pieces[first].outputs = 1;
    pieces[first].output[0] = {static_cast<std::int16_t>(m), true};
    q += step;
  }
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

void expect_on_path(const Motion& motion, const std::vector<LogRecord>& log) {
  for (const LogRecord& record : log) {
    ASSERT_EQ(record.q, motion.trajectory.at(record.nominal_time).q) << "cycle " << record.cycle;
  }
}

TEST(Backward, GoesBackToTheStartRestsThereAndRunsToTheEndAgain) {
  const Motion motion = three_moves();
  RecordedRun run(motion);
  run.ticks(800);
  const double turned = run.log.back().nominal_time;
  run.interpolator.wish(Wish::kBackward);
  run.until(RunState::kPaused);
  EXPECT_EQ(run.log.back().nominal_time, 0.0);
  EXPECT_EQ(run.log.back().q, motion.trajectory.at(0.0).q);
  EXPECT_GT(turned, 1.0);
  const auto fastest = std::ranges::min(run.log, {}, &LogRecord::rate).rate;
  EXPECT_EQ(fastest, -1.0);
  run.ticks(5);
  EXPECT_EQ(run.log.back().state, RunState::kPaused) << "the start is as far as it goes";
  run.interpolator.wish(Wish::kRun);
  run.until(RunState::kFinished);
  EXPECT_EQ(run.interpolator.state(), RunState::kFinished);
  EXPECT_EQ(run.log.back().q, motion.trajectory.at(motion.trajectory.duration()).q);
  expect_on_path(motion, run.log);
}

TEST(Backward, KeepsTheOverrideAndMayPauseAndStop) {
  const Motion motion = three_moves();
  RecordedRun run(motion);
  run.ticks(600);
  run.interpolator.set_override(0.5);
  run.interpolator.wish(Wish::kBackward);
  run.ticks(150);
  EXPECT_EQ(run.log.back().rate, -0.5);
  EXPECT_EQ(run.log.back().state, RunState::kRunning);
  run.interpolator.wish(Wish::kPause);
  run.until(RunState::kPaused);
  const double paused = run.log.back().nominal_time;
  EXPECT_GT(paused, 0.0);
  run.interpolator.wish(Wish::kBackward);
  run.ticks(40);
  EXPECT_LT(run.log.back().nominal_time, paused);
  run.interpolator.wish(Wish::kStop);
  run.until(RunState::kStopped);
  EXPECT_TRUE(run.log.back().qd.isZero(0.0));
  expect_on_path(motion, run.log);
}

TEST(Backward, HoldsTheOutputsUntilItIsPastWhereItTurned) {
  const Motion motion = three_moves();
  RecordedRun run(motion);
  while (run.tick().move < 1) {
  }
  run.ticks(50);
  ASSERT_EQ(run.log.back().outputs, 3U);
  run.interpolator.wish(Wish::kBackward);
  run.until(RunState::kPaused);
  run.interpolator.wish(Wish::kRun);
  run.until(RunState::kFinished);
  std::uint64_t last = 0;
  for (const LogRecord& record : run.log) {
    ASSERT_GE(record.outputs, last) << "an output was taken back in cycle " << record.cycle;
    last = record.outputs;
    ASSERT_TRUE(record.move < 2 || record.outputs == 7U);
  }
  EXPECT_EQ(last, 7U);
}

TEST(Step, EndsAtRestExactlyWhereTheMoveEnds) {
  const Motion motion = three_moves();
  RecordedRun run(motion);
  for (int move = 0; move < 3; ++move) {
    SCOPED_TRACE(move);
    run.interpolator.wish(Wish::kStep);
    run.until(RunState::kPaused);
    std::size_t next = 0;
    const auto& pieces = motion.trajectory.pieces();
    while (next < pieces.size() && pieces[next].move <= move) ++next;
    if (next == pieces.size()) break;
    EXPECT_EQ(run.log.back().nominal_time, motion.trajectory.start_of(next));
    run.ticks(5);
    EXPECT_EQ(run.log.back().nominal_time, motion.trajectory.start_of(next));
    EXPECT_EQ(run.log.back().state, RunState::kPaused);
    EXPECT_TRUE(run.log.back().qd.isZero(0.0));
  }
  EXPECT_EQ(run.interpolator.state(), RunState::kFinished);
  expect_on_path(motion, run.log);
}

TEST(Step, RestsSoonAfterAMoveThatEndsAtSpeed) {
  std::mt19937 random(4);
  const Motion motion = curved_motion(random);  // each piece is a move, none ends at rest
  RecordedRun run(motion);
  run.interpolator.wish(Wish::kStep);
  run.until(RunState::kPaused);
  ASSERT_TRUE(run.interpolator.active());
  const auto next = std::ranges::find(run.log, 1, &LogRecord::move);
  ASSERT_NE(next, run.log.end());
  EXPECT_TRUE(next->state == RunState::kPausing) << to_string(next->state);
  const int rests_in = run.log.back().move;
  run.interpolator.wish(Wish::kStep);
  run.until(RunState::kPaused);
  EXPECT_GT(run.log.back().move, rests_in);
  expect_on_path(motion, run.log);
}

TEST(Step, PausesAndGoesOnLikeAnyRun) {
  const Motion motion = three_moves();
  RecordedRun run(motion);
  run.interpolator.wish(Wish::kStep);
  run.ticks(60);
  run.interpolator.wish(Wish::kPause);
  run.until(RunState::kPaused);
  EXPECT_EQ(run.log.back().move, 0);
  run.interpolator.wish(Wish::kRun);
  run.until(RunState::kFinished);
  EXPECT_EQ(std::ranges::count(run.log, RunState::kFinished, &LogRecord::state), 1);
}

/// Largest rates of every joint by differences of the setpoints, as shares of the limits.
double worst_difference(const std::vector<LogRecord>& log, const JointLimits& limits) {
  double worst = 0.0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    for (int i = 0; i < limits.joints(); ++i) {
      const auto share = [&](const JointVector& a, const JointVector& b, double limit) {
        return std::abs(b[i] - a[i]) / (kSeconds * limit);
      };
      worst = std::max({worst, share(log[k - 1].q, log[k].q, limits.velocity[i]),
                        share(log[k - 1].qd, log[k].qd, limits.acceleration[i]),
                        share(log[k - 1].qdd, log[k].qdd, limits.jerk[i])});
    }
  }
  return worst;
}

TEST(ReturnToPath, AJogWhilePausedIsTakenBackBeforeTheMotionGoesOn) {
  const Motion motion = three_moves();
  RecordedRun run(motion);
  run.ticks(300);
  run.interpolator.wish(Wish::kPause);
  run.until(RunState::kPaused);
  const LogRecord left = run.log.back();
  JointVector away(2);
  away << -0.5, 1.0;
  for (int k = 0; k < 100; ++k) {
    if (k % 20 == 0) run.interpolator.jog(away);
    EXPECT_EQ(run.tick().state, RunState::kJogging);
  }
  run.until(RunState::kPaused);
  EXPECT_GT((run.log.back().q - left.q).norm(), 0.1);
  run.interpolator.wish(Wish::kRun);
  EXPECT_EQ(run.tick().state, RunState::kReturning);
  while (run.tick().state == RunState::kReturning) {
  }
  const std::size_t back = run.log.size() - 1;
  EXPECT_EQ(run.log[back - 1].q, left.q);
  EXPECT_EQ(run.log[back].nominal_time, left.nominal_time);
  run.until(RunState::kFinished);
  EXPECT_EQ(run.log.back().q, motion.trajectory.at(motion.trajectory.duration()).q);
  for (std::size_t k = back; k < run.log.size(); ++k) {
    ASSERT_EQ(run.log[k].q, motion.trajectory.at(run.log[k].nominal_time).q);
  }
  EXPECT_LE(worst_difference(run.log, motion.limits), 1.0 + 1e-6);
}

TEST(ReturnToPath, MayPauseBeJoggedAgainStopAndRunSlowly) {
  const Motion motion = three_moves();
  RecordedRun run(motion);
  run.ticks(300);
  run.interpolator.wish(Wish::kPause);
  run.until(RunState::kPaused);
  const JointVector left = run.log.back().q;
  const auto jog = [&](double speed) {
    run.interpolator.jog(JointVector::Constant(2, speed));
    run.until(RunState::kPaused);
  };
  jog(1.0);
  run.interpolator.set_override(0.2);
  run.interpolator.wish(Wish::kRun);
  run.ticks(80);
  EXPECT_EQ(run.log.back().state, RunState::kReturning);
  EXPECT_NEAR(run.log.back().qd.cwiseAbs().maxCoeff(), 0.2 * 2.0, 1e-9);
  run.interpolator.wish(Wish::kPause);
  run.interpolator.jog(JointVector::Constant(2, 1.0));  // not at rest: refused
  EXPECT_EQ(run.tick().state, RunState::kPausing);
  run.until(RunState::kPaused);
  EXPECT_NE(run.log.back().q, left);
  jog(-1.0);
  run.interpolator.wish(Wish::kRun);
  run.ticks(30);
  run.interpolator.wish(Wish::kStop);
  run.until(RunState::kStopped);
  EXPECT_FALSE(run.interpolator.active());
  EXPECT_TRUE(run.log.back().qd.isZero(0.0));
  EXPECT_LE(worst_difference(run.log, motion.limits), 1.0 + 1e-6);
}

/// Everything an operator can wish, at random; no stop, so that the motion ends.
void command_at_random(std::mt19937& random, Interpolator& interpolator, int joints) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  switch (std::uniform_int_distribution<int>(0, 7)(random)) {
    case 0:
    case 1:
      return interpolator.set_override(unit(random) < 0.2 ? 1.0 : unit(random));
    case 2:
      return interpolator.wish(Wish::kPause);
    case 3:
      return interpolator.wish(Wish::kStep);
    case 4:
      return interpolator.wish(Wish::kBackward);
    case 5:
      return interpolator.jog(JointVector::Random(joints) * 0.1);
    default:
      return interpolator.wish(Wish::kRun);
  }
}

TEST(PathCommands, AtRandomNeverLeaveThePathOrTheLimitsAndTheMotionEnds) {
  constexpr unsigned kMotions = problems(300U);
  double worst = 0.0;
  int backward = 0, jogged = 0, returned = 0;
  for (unsigned seed = 0; seed < kMotions; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::srand(seed);
    const Motion motion = random_motion(random);
    RecordedRun run(motion);
    const double eagerness = std::uniform_real_distribution<double>(0.005, 0.08)(random);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    while (run.interpolator.active()) {
      ASSERT_LT(run.log.size(), 30'000U);
      if (run.log.size() < 1500 && unit(random) < eagerness) {
        command_at_random(random, run.interpolator, motion.limits.joints());
      } else if (run.log.size() == 1500) {
        run.interpolator.set_override(1.0);
        run.interpolator.wish(Wish::kRun);
      }
      run.tick();
    }
    ASSERT_EQ(run.interpolator.state(), RunState::kFinished);
    std::vector<LogRecord> stretch;
    const auto judge = [&] {
      const Shares shares = worst_shares(motion, stretch, kSeconds, 10);
      ASSERT_LE(shares.worst(), 1.0 + 1e-6) << "cycle " << stretch.front().cycle + shares.cycle;
      worst = std::max(worst, shares.worst());
      stretch.clear();
    };
    bool off = false;
    for (const LogRecord& record : run.log) {
      backward += record.rate < 0.0 ? 1 : 0;
      jogged += record.state == RunState::kJogging ? 1 : 0;
      returned += record.state == RunState::kReturning ? 1 : 0;
      if (record.state == RunState::kJogging) off = true;
      if (record.state == RunState::kRunning) off = false;
      if (off) {
        judge();
      } else {
        ASSERT_EQ(record.q, motion.trajectory.at(record.nominal_time).q);
        stretch.push_back(record);
      }
    }
    judge();
    ASSERT_LE(worst_difference(run.log, motion.limits), 1.0 + 1e-6);
  }
  EXPECT_GT(worst, 0.999) << "the limits were never reached: the test shows nothing";
  EXPECT_GT(backward, problems(1000));
  EXPECT_GT(jogged, problems(1000));
  EXPECT_GT(returned, problems(1000));
}

}  // namespace
}  // namespace viapoint
