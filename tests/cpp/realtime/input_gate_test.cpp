// Motions that wait for an input on their way.
#include "viapoint/realtime/input_gate.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "problem_count.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/guard.hpp"
#include "viapoint/realtime/interpolator.hpp"
#include "viapoint/realtime/virtual_loop.hpp"

namespace viapoint {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kInput = std::uint64_t{1} << 7;

/// Two moves, and between them a wait for input 7.
Motion waiting_motion(double timeout) {
  Motion motion;
  motion.limits = even_limits(2, 2.0, 20.0, 200.0);
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(2), JointVector::Constant(2, 1.0), motion.limits, 0);
  append_wait(pieces, JointVector::Constant(2, 1.0), 2e-3, 1);
  pieces.back().wait = {7, true, timeout};
  append_straight(pieces, JointVector::Constant(2, 1.0), JointVector::Constant(2, 1.0),
                  motion.limits, 2);
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

struct GatedRun {
  explicit GatedRun(const Motion& of)
      : motion(of),
        interpolator(of.limits, kCycle, of.trajectory.at(0.0).q),
        guard(of.limits, kCycle, {}, of.trajectory.at(0.0).q) {
    interpolator.begin(motion.trajectory);
  }
  RunState tick() {
    const NoAllocationScope scope;
    const RunState state = interpolator.tick(setpoint);
    EXPECT_EQ(scope.calls(), 0U);
    EXPECT_EQ(guard.pass(setpoint), Guard::Verdict::kPass) << text_of(guard.breach());
    EXPECT_EQ(setpoint.q, motion.trajectory.at(interpolator.nominal_time()).q);
    return state;
  }
  void until(RunState state) {
    for (int k = 0; k < 20'000; ++k) {
      if (tick() == state) return;
    }
    ADD_FAILURE() << "never " << to_string(state);
  }
  const Motion& motion;
  Interpolator interpolator;
  Guard guard;
  Setpoint setpoint;
};

TEST(InputGate, HoldsTheArmAtItsPlaceAndGoesOnInTheCycleAfterTheInput) {
  const Motion motion = waiting_motion(kForever);
  GatedRun run(motion);
  run.until(RunState::kWaiting);
  EXPECT_EQ(run.setpoint.q, JointVector::Constant(2, 1.0));
  EXPECT_TRUE(run.interpolator.awaits_input());
  EXPECT_EQ(run.interpolator.move(), 1);
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(run.tick(), RunState::kWaiting);
  run.interpolator.set_inputs(~kInput);
  EXPECT_EQ(run.tick(), RunState::kWaiting);
  run.interpolator.set_inputs(kInput);
  EXPECT_EQ(run.tick(), RunState::kRunning);
  EXPECT_FALSE(run.interpolator.awaits_input());
  run.tick();
  run.tick();
  EXPECT_NE(run.setpoint.q, JointVector::Constant(2, 1.0));
  run.until(RunState::kFinished);
}

TEST(InputGate, CostsNoCycleWhereTheInputIsSoAlready) {
  const Motion motion = waiting_motion(1.0);
  GatedRun run(motion);
  run.interpolator.set_inputs(kInput);
  int cycles = 0;
  while (run.interpolator.active()) {
    ASSERT_NE(run.tick(), RunState::kWaiting);
    ++cycles;
  }
  EXPECT_LE(cycles, static_cast<int>(motion.trajectory.duration() / 2e-3) + 4);
}

TEST(InputGate, EndsTheRunAfterTheTimeOutWhichAPauseHolds) {
  const Motion motion = waiting_motion(0.5);
  GatedRun run(motion);
  run.until(RunState::kWaiting);
  for (int k = 1; k < 100; ++k) ASSERT_EQ(run.tick(), RunState::kWaiting);
  run.interpolator.wish(Wish::kPause);
  run.interpolator.set_inputs(kInput);
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(run.tick(), RunState::kPaused);
  run.interpolator.set_inputs(0);
  run.interpolator.wish(Wish::kRun);
  for (int k = 0; k < 150; ++k) ASSERT_EQ(run.tick(), RunState::kWaiting);
  EXPECT_EQ(run.tick(), RunState::kStopped);
  EXPECT_TRUE(run.interpolator.input_missed());
  EXPECT_EQ(run.interpolator.awaited().input, 7);
  EXPECT_FALSE(run.interpolator.active());
}

TEST(InputGate, LetsTheArmGoBackAndWaitsAgainUntilTheInputHasCome) {
  const Motion motion = waiting_motion(kForever);
  GatedRun run(motion);
  run.until(RunState::kWaiting);
  run.interpolator.wish(Wish::kBackward);
  run.until(RunState::kPaused);
  EXPECT_EQ(run.setpoint.q, JointVector::Zero(2));
  run.interpolator.wish(Wish::kRun);
  run.until(RunState::kWaiting);
  EXPECT_EQ(run.setpoint.q, JointVector::Constant(2, 1.0));
  run.interpolator.set_inputs(kInput);
  for (int k = 0; k < 100; ++k) run.tick();
  run.interpolator.set_inputs(0);
  run.interpolator.wish(Wish::kBackward);
  run.until(RunState::kPaused);
  run.interpolator.wish(Wish::kRun);
  while (run.interpolator.active()) ASSERT_NE(run.tick(), RunState::kWaiting) << "it has come";
  EXPECT_EQ(run.interpolator.state(), RunState::kFinished);
}

TEST(InputGate, StopsAndStepsLikeAnyRest) {
  const Motion motion = waiting_motion(kForever);
  GatedRun stopped(motion);
  stopped.until(RunState::kWaiting);
  stopped.interpolator.wish(Wish::kStop);
  EXPECT_EQ(stopped.tick(), RunState::kStopped);
  EXPECT_FALSE(stopped.interpolator.input_missed());
  GatedRun stepped(motion);
  stepped.interpolator.wish(Wish::kStep);
  stepped.until(RunState::kPaused);
  EXPECT_EQ(stepped.setpoint.q, JointVector::Constant(2, 1.0));
  stepped.interpolator.wish(Wish::kStep);
  EXPECT_EQ(stepped.tick(), RunState::kWaiting);
}

TEST(InputGate, KeepsThePathAndTheLimitsWhateverIsCommanded) {
  for (unsigned seed = 0; seed < problems(150U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = waiting_motion(kForever);
    GatedRun run(motion);
    bool has_come = false;
    for (int k = 0; k < 20'000 && run.interpolator.active(); ++k) {
      const bool is_on = k > 3000 || random() % 400 == 0;
      run.interpolator.set_inputs(is_on ? kInput : 0);
      if (k > 3000) {
        run.interpolator.set_override(1.0);
        run.interpolator.wish(Wish::kRun);
      } else if (random() % 60 == 0) {
        run.interpolator.set_override(static_cast<double>(random() % 5) / 4.0);
        constexpr Wish kWishes[] = {Wish::kRun, Wish::kPause, Wish::kBackward, Wish::kStep};
        run.interpolator.wish(kWishes[random() % 4]);
      }
      const bool awaited = run.interpolator.awaits_input();
      const RunState state = run.tick();
      has_come = has_come || (awaited && is_on && state == RunState::kRunning);
      const double place = motion.trajectory.start_of(motion.trajectory.waits().front());
      ASSERT_TRUE(has_come || run.interpolator.nominal_time() <= place);
    }
    ASSERT_EQ(run.interpolator.state(), RunState::kFinished);
    if (HasFailure()) return;
  }
}

TEST(InputGate, IsRefusedOnAPieceThatMoves) {
  const Motion motion = waiting_motion(1.0);
  const auto refused = [&](const InputWait& wait, std::size_t piece) {
    std::vector<TrajectoryPiece> pieces = motion.trajectory.pieces();
    pieces[piece].wait = wait;
    EXPECT_THROW(Trajectory(pieces, motion.limits), MotionError);
  };
  const std::size_t rest = motion.trajectory.waits().front();
  refused({7, true, 1.0}, 0);
  refused({64, true, 1.0}, rest);
  refused({-2, true, 1.0}, rest);
  refused({7, true, 0.0}, rest);
  refused({7, true, std::nan("")}, rest);
}

TEST(InputGate, TellsTheJobWhatItWaitsForAndWhatDidNotCome) {
  const Motion motion = waiting_motion(0.2);
  const auto inputs = std::make_shared<std::atomic<std::uint64_t>>(0);
  VirtualLoop loop(std::make_unique<SimulatedDrive>(JointVector::Zero(2), inputs), motion.limits);
  for (const bool comes : {true, false}) {
    const auto job = loop.run(std::make_shared<Trajectory>(motion.trajectory));
    while (job->state() != RunState::kWaiting) loop.pass(1);
    ASSERT_TRUE(job->awaited());
    EXPECT_EQ(job->awaited()->input, 7);
    EXPECT_FLOAT_EQ(static_cast<float>(job->awaited()->timeout), 0.2F);
    if (comes) {
      *inputs = kInput;
      while (!job->wait(0.0)) loop.pass(100);
      EXPECT_EQ(job->state(), RunState::kFinished);
      EXPECT_FALSE(job->awaited());
      *inputs = 0;
      // Back to where it began.
      std::vector<TrajectoryPiece> back;
      append_straight(back, JointVector::Constant(2, 2.0), JointVector::Constant(2, -2.0),
                      motion.limits, 0);
      const auto way = loop.run(std::make_shared<Trajectory>(std::move(back), motion.limits));
      while (!way->wait(0.0)) loop.pass(100);
      continue;
    }
    for (int k = 0; k < 200 && job->state() != RunState::kStopped; ++k) loop.pass(1);
    loop.pass(1);
    try {
      (void)job->wait(0.0);
      FAIL() << "the input did not come";
    } catch (const MotionError& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInputTimeout);
      EXPECT_EQ(error.problem().move, 1);
    }
    EXPECT_FALSE(loop.busy());
    EXPECT_TRUE(loop.fault().empty());
  }
}

}  // namespace
}  // namespace viapoint
