// The loop on the machine's clock, and on clocks that jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {
namespace {

const JointLimits kLimits = even_limits(2, 2.0, 20.0, 200.0);
constexpr std::int64_t kCycle = 2'000'000;

/// Two joints, from zero to `end` rad.
std::shared_ptr<const Trajectory> move_to(double end) {
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(2), JointVector::Constant(2, end), kLimits, 7);
  return std::make_shared<Trajectory>(std::move(pieces), kLimits);
}

std::unique_ptr<ControllerLoop> loop_of(std::unique_ptr<Clock> clock,
                                        const LoopOptions& options = {}) {
  return std::make_unique<ControllerLoop>(std::make_unique<SimulatedDrive>(JointVector::Zero(2)),
                                          kLimits, options, std::move(clock));
}

/// Tells when the arm has begun to move.
class TellingDrive final : public Drive {
 public:
  explicit TellingDrive(std::shared_ptr<std::atomic<bool>> moves) : moves_(std::move(moves)) {}
  [[nodiscard]] int joints() const override { return drive_.joints(); }
  Measurement enable() override { return drive_.enable(); }
  [[nodiscard]] DriveStatus exchange(const Setpoint& setpoint,
                                     Measurement& measurement) noexcept override {
    if (!setpoint.qd.isZero(0.0)) *moves_ = true;
    return drive_.exchange(setpoint, measurement);
  }
  void release() noexcept override { drive_.release(); }

 private:
  SimulatedDrive drive_{JointVector::Zero(2)};
  std::shared_ptr<std::atomic<bool>> moves_;
};

/// Jumps once, in a sleep after the arm has begun to move.
class JumpingClock final : public Clock {
 public:
  JumpingClock(std::shared_ptr<const std::atomic<bool>> moves, std::int64_t jump)
      : moves_(std::move(moves)), jump_(jump) {}
  [[nodiscard]] std::int64_t now() const noexcept override { return now_; }
  void sleep_until(std::int64_t instant) noexcept override {
    now_ = std::max(now_, instant);
    if (*moves_ && ++sleeps_ == kSleep) now_ += jump_;
  }
  [[nodiscard]] bool is_virtual() const noexcept override { return true; }

 private:
  static constexpr int kSleep = 1000;
  std::shared_ptr<const std::atomic<bool>> moves_;
  std::int64_t jump_;
  int sleeps_ = 0;
  std::int64_t now_ = 0;
};

std::unique_ptr<ControllerLoop> jumping_loop(std::int64_t jump) {
  const auto moves = std::make_shared<std::atomic<bool>>(false);
  return std::make_unique<ControllerLoop>(std::make_unique<TellingDrive>(moves), kLimits,
                                          LoopOptions{},
                                          std::make_unique<JumpingClock>(moves, jump));
}

/// One cycle of the motion a cycle of the loop, whatever the clock says.
void expect_no_jump(const Job& job, const Trajectory& motion) {
  const std::vector<LogRecord> log = job.log();
  for (std::size_t k = 0; k < log.size(); ++k) {
    const double due = std::min(static_cast<double>(k) * 2e-3, motion.duration());
    ASSERT_NEAR(log[k].nominal_time, due, 1e-12);
    ASSERT_EQ(log[k].q, motion.at(log[k].nominal_time).q);
  }
}

TEST(LoopClock, AMissedCycleDelaysTheMotionAndNeverMakesItJump) {
  const auto motion = move_to(30.0);
  const auto loop = jumping_loop(3 * kCycle + kCycle / 2);
  const auto job = loop->run(motion);
  ASSERT_TRUE(job->wait(30.0));
  const RunReport report = job->report();
  ASSERT_EQ(report.overruns, 1U) << "the late cycle did not fall into the run";
  EXPECT_EQ(job->overruns(), 1U);
  EXPECT_EQ(report.missed_cycles, 3U);
  EXPECT_NEAR(report.wall_time, motion->duration() + 3 * 2e-3, 2e-3 + 1e-6);
  expect_no_jump(*job, *motion);
}

TEST(LoopClock, AJumpAheadOfSecondsDelaysTheMotionToo) {
  constexpr std::int64_t kCycles = 2500;
  const auto motion = move_to(30.0);
  const auto loop = jumping_loop(kCycles * kCycle);
  const auto job = loop->run(motion);
  ASSERT_TRUE(job->wait(30.0));
  EXPECT_EQ(job->state(), RunState::kFinished) << loop->fault();
  EXPECT_EQ(job->report().missed_cycles, static_cast<std::uint64_t>(kCycles));
  expect_no_jump(*job, *motion);
}

/// Whoever was to be heard of meanwhile has not been.
TEST(LoopClock, AJumpAheadBeyondTheLeasePausesTheRunOnItsPath) {
  const auto motion = move_to(30.0);
  const auto loop = jumping_loop(3600LL * 1'000'000'000);
  loop->keep_alive(std::chrono::minutes(10));
  const auto job = loop->run(motion);
  for (int k = 0; k < 30'000 && job->state() != RunState::kPaused; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(job->state(), RunState::kPaused);
  EXPECT_LT(job->nominal_time(), job->duration());
  for (const LogRecord& record : job->log()) {
    ASSERT_EQ(record.q, motion->at(record.nominal_time).q);
    ASSERT_LE(record.qdd.cwiseAbs().maxCoeff(), 20.0 * (1.0 + 1e-6));
  }
}

TEST(LoopClock, AJumpBackLeavesNoGapBetweenSetpoints) {
  const auto motion = move_to(30.0);
  const auto loop = jumping_loop(-1'000'000'000);
  const auto job = loop->run(motion);
  ASSERT_TRUE(job->wait(30.0));
  EXPECT_EQ(job->state(), RunState::kFinished) << loop->fault();
  EXPECT_EQ(job->report().missed_cycles, 0U);
  expect_no_jump(*job, *motion);
  const std::vector<LogRecord> log = job->log();
  int jumps = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const std::int64_t step = log[k].stamp - log[k - 1].stamp;
    jumps += step < 0 ? 1 : 0;
    ASSERT_LE(step, kCycle) << "cycle " << k;
  }
  EXPECT_EQ(jumps, 1) << "the jump did not fall into the run";
}

TEST(LoopClock, WallTimeOnTheMachinesClockIsTheDuration) {
  const auto loop = loop_of(std::make_unique<MonotonicClock>());
  const auto motion = move_to(0.8);
  const std::int64_t before = MonotonicClock().now();
  const auto job = loop->run(motion);
  ASSERT_TRUE(job->wait(20.0));
  const RunReport report = job->report();
  const double missed = 2e-3 * static_cast<double>(report.missed_cycles);
  // The wake-ups' own lateness at both ends comes on top.
  EXPECT_NEAR(report.wall_time, motion->duration() + missed, 2e-3 + 2 * report.latency_max);
  const auto log = job->log();
  EXPECT_GE(log.front().stamp, before);
  EXPECT_LE(log.back().stamp, MonotonicClock().now());
  EXPECT_GT(report.compute_p50, 0.0);
  for (const std::string& line : loop->shortcomings()) {
    EXPECT_NE(line.find("allow it with"), std::string::npos) << line;
  }
}

TEST(LoopClock, SaysInALineWhatOfTheMachineItCannotHave) {
  LoopOptions options;
  options.keep_awake = false;
  options.processor = 0;
  const auto lines_of = [&] {
    return loop_of(std::make_unique<MonotonicClock>(), options)->shortcomings();
  };
  const std::size_t others = lines_of().size();
  options.processor = 1'000'000;
  const std::vector<std::string> lines = lines_of();
  ASSERT_EQ(lines.size(), others + 1);
  EXPECT_NE(lines.back().find("not kept on processor 1000000"), std::string::npos) << lines.back();
}

/// Busy threads on every processor, twice over, on the machine's clock. How late a cycle is, is the
/// machine's; that none is left out of the motion, and each that was slept through is counted, is
/// not.
TEST(LoopClock, AProcessorHogNeverMakesTheMotionJump) {
  const auto loop = loop_of(std::make_unique<MonotonicClock>());
  for (const std::string& line : loop->shortcomings()) {
    if (line.find("SCHED_FIFO") != std::string::npos) GTEST_SKIP() << "SKIPPED: " << line;
  }
  const auto motion = move_to(2.0);
  std::atomic<bool> over{false};
  std::vector<std::jthread> hogs;
  for (unsigned k = 0; k < 2 * std::max(1U, std::thread::hardware_concurrency()); ++k) {
    hogs.emplace_back([&over] {
      while (!over.load(std::memory_order_relaxed)) {
      }
    });
  }
  const auto job = loop->run(motion);
  const bool has_ended = job->wait(60.0);
  over = true;
  ASSERT_TRUE(has_ended);
  EXPECT_EQ(job->state(), RunState::kFinished) << loop->fault();
  expect_no_jump(*job, *motion);
  const RunReport report = job->report();
  EXPECT_GE(report.missed_cycles, report.overruns);
  const double late = report.wall_time - motion->duration();
  EXPECT_LE(late, 2e-3 * static_cast<double>(report.missed_cycles) + 2e-3 + 2 * report.latency_max);
}

}  // namespace
}  // namespace viapoint
