#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "realtime/random_motion.hpp"
#include "realtime/rate_path.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {
namespace {

using Kind = TimedCommand::Kind;
constexpr std::chrono::nanoseconds kCycle{2'000'000};

Motion motion_of(unsigned seed) {
  std::mt19937 random(seed);
  return curved_motion(random);
}

TEST(Simulate, WithoutCommandsIsTheMotionItself) {
  const Motion motion = motion_of(1);
  const auto log = simulate(motion.trajectory, motion.limits, {}, kCycle);
  EXPECT_EQ(log.back().state, RunState::kFinished);
  EXPECT_EQ(log.back().nominal_time, motion.trajectory.duration());
  for (std::size_t k = 0; k + 1 < log.size(); ++k) {
    EXPECT_EQ(log[k].nominal_time, static_cast<double>(k) * 2e-3);
  }
}

TEST(Simulate, TheSameCommandsGiveTheSameBits) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Motion motion = motion_of(seed);
    const double T = motion.trajectory.duration();
    const std::vector<TimedCommand> commands = {{0.2 * T, Kind::kOverride, 0.4},
                                                {0.3 * T, Kind::kPause, 0.0},
                                                {0.9 * T, Kind::kResume, 0.0},
                                                {1.5 * T, Kind::kStop, 0.0}};
    const auto a = simulate(motion.trajectory, motion.limits, commands, kCycle);
    const auto b = simulate(motion.trajectory, motion.limits, commands, kCycle);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      ASSERT_EQ(a[k].q, b[k].q);
      ASSERT_EQ(a[k].qddd, b[k].qddd);
    }
  }
}

TEST(Simulate, CommandsTakeEffectAtTheirCycleWhateverTheirOrder) {
  const Motion motion = motion_of(2);
  const auto log = simulate(motion.trajectory, motion.limits,
                            {{0.02, Kind::kStop, 0.0}, {0.01, Kind::kPause, 0.0}}, kCycle);
  EXPECT_EQ(log[4].state, RunState::kRunning);
  EXPECT_EQ(log[5].state, RunState::kPausing);
  EXPECT_TRUE(log[10].state == RunState::kStopping || log[10].state == RunState::kStopped);
}

TEST(Simulate, APauseWithoutResumeEndsAtRest) {
  const Motion motion = motion_of(3);
  const auto log = simulate(motion.trajectory, motion.limits, {{0.02, Kind::kPause, 0.0}}, kCycle);
  EXPECT_EQ(log.back().state, RunState::kPaused);
  EXPECT_TRUE(log.back().qd.isZero(0.0));
}

TEST(Simulate, CommandsAfterTheEndAreIgnored) {
  const Motion motion = motion_of(4);
  const auto log = simulate(motion.trajectory, motion.limits, {{100.0, Kind::kStop, 0.0}}, kCycle);
  EXPECT_EQ(log.back().state, RunState::kFinished);
}

TEST(Simulate, RefusesBadCommandsAndCycles) {
  const Motion motion = motion_of(5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const TimedCommand& bad :
       {TimedCommand{-1.0, Kind::kPause, 0.0}, TimedCommand{nan, Kind::kPause, 0.0},
        TimedCommand{0.0, Kind::kOverride, 1.5}, TimedCommand{0.0, Kind::kOverride, nan}}) {
    EXPECT_THROW(static_cast<void>(simulate(motion.trajectory, motion.limits, {bad}, kCycle)),
                 MotionError);
  }
  EXPECT_THROW(static_cast<void>(
                   simulate(motion.trajectory, motion.limits, {}, std::chrono::nanoseconds(0))),
               MotionError);
  EXPECT_THROW(static_cast<void>(simulate(Trajectory(), motion.limits, {}, kCycle)), MotionError);
}

/// What a run that is refused says.
std::string refusal(const Motion& motion, std::vector<TimedCommand> commands,
                    std::chrono::nanoseconds cycle) {
  std::string message = "no error";
  try {
    static_cast<void>(simulate(motion.trajectory, motion.limits, std::move(commands), cycle));
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    message = error.what();
  }
  return message;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Simulate, TellsAnOverrideJustAboveItsBoundApartFromIt) {
  const Motion motion = motion_of(5);
  EXPECT_TRUE(has(refusal(motion, {{0.0, Kind::kOverride, 1.0000001}}, kCycle), "1.0000001"));
}

TEST(Simulate, RefusesRunsLongerThanItsLogBeforeItFillsIt) {
  const Motion motion = motion_of(6);
  const std::chrono::microseconds shortest(1);
  const std::vector<std::string> refusals = {
      refusal(motion, {{0.0, Kind::kOverride, 1e-6}}, kCycle),
      refusal(motion, {{0.05, Kind::kOverride, 1e-6}}, kCycle),
      refusal(motion, {{0.05, Kind::kPause, 0.0}, {1e5, Kind::kResume, 0.0}}, kCycle),
      refusal(motion, {{0.05, Kind::kOverride, 2e-6}, {1e5, Kind::kOverride, 1.0}}, kCycle),
      refusal(motion, {{0.05, Kind::kPause, 0.0}, {3.0, Kind::kResume, 0.0}}, shortest),
  };
  for (const std::string& message : refusals) {
    EXPECT_TRUE(has(message, "at most 2000000 fit")) << message;
    // Filled to its end the log would say that a cycle more is needed; what is foreseen is more.
    EXPECT_FALSE(has(message, "at least 2e+06 ") || has(message, "at least 2000001 ")) << message;
  }
  EXPECT_TRUE(has(refusal(motion, {}, std::chrono::nanoseconds(10)), "at least 1000 ns"));
}

TEST(Simulate, ASlowRunThatIsMadeQuickerInTimeIsRun) {
  const Motion motion = motion_of(6);
  const auto log = simulate(motion.trajectory, motion.limits,
                            {{0.05, Kind::kOverride, 2e-6},
                             {5.0, Kind::kPause, 0.0},
                             {9.0, Kind::kOverride, 1.0},
                             {9.0, Kind::kResume, 0.0}},
                            kCycle);
  EXPECT_EQ(log.back().state, RunState::kFinished);
}

TEST(Simulate, KeepsLimitsAtOtherCyclesToo) {
  for (const int microseconds : {250, 1000, 8000, 20000}) {
    for (unsigned seed = 0; seed < 30; ++seed) {
      SCOPED_TRACE(testing::Message() << microseconds << " us, seed " << seed);
      const Motion motion = motion_of(seed);
      const double T = motion.trajectory.duration();
      const auto log = simulate(motion.trajectory, motion.limits,
                                {{0.2 * T, Kind::kOverride, 0.3}, {0.6 * T, Kind::kOverride, 1.0}},
                                std::chrono::microseconds(microseconds));
      ASSERT_LE(worst_shares(motion, log, microseconds * 1e-6, 20).worst(), 1.0 + 1e-6);
      ASSERT_EQ(log.back().state, RunState::kFinished);
    }
  }
}

}  // namespace
}  // namespace viapoint
