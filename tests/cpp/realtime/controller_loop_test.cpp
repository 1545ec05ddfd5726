#include "viapoint/realtime/controller_loop.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "realtime/random_motion.hpp"
#include "realtime/thread_shortage.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"

namespace viapoint {
namespace {

using std::chrono::milliseconds;

ErrorCode code_of(const auto& action) {
  try {
    action();
  } catch (const MotionError& error) {
    EXPECT_FALSE(error.problem().message.empty());
    return error.code();
  }
  ADD_FAILURE() << "nothing was refused";
  return ErrorCode::kInternal;
}

/// Two joints, from zero to `step` rad.
std::shared_ptr<const Trajectory> move_by(double step, const JointLimits& limits,
                                          double from = 0.0) {
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Constant(2, from), JointVector::Constant(2, step), limits,
                  7);
  return std::make_shared<Trajectory>(std::move(pieces), limits);
}

const JointLimits kLimits = even_limits(2, 2.0, 20.0, 200.0);

std::unique_ptr<ControllerLoop> virtual_loop(
    std::unique_ptr<Drive> drive = std::make_unique<SimulatedDrive>(JointVector::Zero(2))) {
  return std::make_unique<ControllerLoop>(std::move(drive), kLimits, LoopOptions{},
                                          std::make_unique<VirtualClock>());
}

/// What happened to a drive, for tests that look after the loop has gone.
struct DriveHistory {
  std::atomic<int> enabled{0}, released{0};
  std::atomic<bool> failing{false};
  std::atomic<std::uint64_t> exchanges{0};
  /// Fails once it is told the same place twice, away from where it began.
  bool fails_at_rest = false;
  JointVector last_qd;  ///< of the last setpoint; read after the loop has gone
};

class WatchedDrive final : public Drive {
 public:
  explicit WatchedDrive(std::shared_ptr<DriveHistory> history)
      : history_(std::move(history)), arm_(JointVector::Zero(2)) {}
  [[nodiscard]] int joints() const override { return 2; }
  Measurement enable() override {
    ++history_->enabled;
    return arm_.enable();
  }
  DriveStatus exchange(const Setpoint& setpoint, Measurement& measurement) noexcept override {
    ++history_->exchanges;
    history_->last_qd = setpoint.qd;
    if (history_->failing) return DriveStatus::kFault;
    const bool told_again = setpoint.q == told_ && !told_.isZero(0.0);
    if (history_->fails_at_rest && told_again) return DriveStatus::kFault;
    told_ = setpoint.q;
    return arm_.exchange(setpoint, measurement);
  }
  void release() noexcept override { ++history_->released; }
  [[nodiscard]] std::string fault() const override { return "joint 2 is too hot"; }

 private:
  std::shared_ptr<DriveHistory> history_;
  SimulatedDrive arm_;
  JointVector told_ = JointVector::Zero(2);
};

TEST(ControllerLoop, RunsAMotionAndLogsEveryCycle) {
  const auto loop = virtual_loop();
  const auto trajectory = move_by(1.0, kLimits);
  const auto job = loop->run(trajectory);
  ASSERT_TRUE(job->wait(20.0));
  EXPECT_EQ(job->state(), RunState::kFinished);
  EXPECT_EQ(job->nominal_time(), trajectory->duration());
  EXPECT_EQ(job->duration(), trajectory->duration());
  EXPECT_EQ(job->move(), 7);

  const std::vector<LogRecord> log = job->log();
  ASSERT_EQ(log.size(), static_cast<std::size_t>(std::ceil(trajectory->duration() / 2e-3)) + 1);
  for (std::size_t k = 0; k < log.size(); ++k) {
    EXPECT_EQ(log[k].cycle, k);
    EXPECT_EQ(log[k].stamp - log[0].stamp, static_cast<std::int64_t>(k) * 2'000'000);
    EXPECT_EQ(log[k].q, trajectory->at(log[k].nominal_time).q);
    if (k > 0) {
      EXPECT_EQ(log[k].measured, log[k - 1].q);
    }
  }
  const RunReport report = job->report();
  EXPECT_EQ(report.cycles, log.size());
  EXPECT_EQ(report.overruns, 0U);
  EXPECT_EQ(report.lost_records, 0U);
  EXPECT_NEAR(report.wall_time, trajectory->duration(), 2e-3);
  EXPECT_EQ(loop->position(), log.back().q);
  EXPECT_FALSE(loop->busy());
}

TEST(ControllerLoop, GivesTheSetpointsOfASimulatedRunToTheLastBit) {
  const auto loop = virtual_loop();
  const auto trajectory = move_by(-2.0, kLimits);
  loop->set_override(0.7);
  const auto job = loop->run(trajectory);
  ASSERT_TRUE(job->wait(20.0));
  const auto simulated =
      simulate(*trajectory, kLimits, {{0.0, TimedCommand::Kind::kOverride, 0.7}}, milliseconds(2));
  const auto log = job->log();
  ASSERT_EQ(log.size(), simulated.size());
  for (std::size_t k = 0; k < log.size(); ++k) {
    ASSERT_EQ(log[k].q, simulated[k].q);
    ASSERT_EQ(log[k].qddd, simulated[k].qddd);
    ASSERT_EQ(log[k].nominal_time, simulated[k].nominal_time);
  }
}

TEST(ControllerLoop, TheEndIsMeasuredWhenTheRunHasEnded) {
  const auto loop = virtual_loop();
  double from = 0.0;
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const bool stops = i % 2 == 1;
    const auto job = loop->run(move_by(from < 0.5 ? 1.0 : 0.0, kLimits, from));
    if (stops) job->stop();
    while (job->state() != RunState::kFinished && job->state() != RunState::kStopped) {
      std::this_thread::yield();
    }
    const JointVector measured = loop->measured().q;
    ASSERT_TRUE(job->wait(20.0));
    ASSERT_EQ(measured, job->log().back().q) << "the state told the end too early";
    ASSERT_EQ(loop->measured().q, loop->position());
    from = measured[0];
  }
}

TEST(ControllerLoop, ADriveThatFailsWithTheEndPointOnItsWayFailsTheRun) {
  const auto history = std::make_shared<DriveHistory>();
  history->fails_at_rest = true;
  const auto loop = virtual_loop(std::make_unique<WatchedDrive>(history));
  const auto trajectory = move_by(0.1, kLimits);
  const auto job = loop->run(trajectory);
  EXPECT_EQ(code_of([&] { job->wait(20.0); }), ErrorCode::kDriveFault);
  EXPECT_EQ(job->state(), RunState::kFault);
  const auto log = job->log();
  ASSERT_GE(log.size(), 2U);
  EXPECT_EQ(log.back().state, RunState::kFault);
  EXPECT_EQ(log[log.size() - 2].state, RunState::kFinished);
  EXPECT_EQ(job->nominal_time(), trajectory->duration());
}

TEST(ControllerLoop, RefusesWhatMustNotRunBeforeAnythingMoves) {
  const auto loop = virtual_loop();
  EXPECT_EQ(code_of([&] { static_cast<void>(loop->run(nullptr)); }), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of([&] { static_cast<void>(loop->run(std::make_shared<Trajectory>())); }),
            ErrorCode::kEmptyProgram);
  EXPECT_EQ(code_of([&] { static_cast<void>(loop->run(move_by(1.0, kLimits, 0.1))); }),
            ErrorCode::kNotAtStart);
  EXPECT_EQ(code_of([&] {
              static_cast<void>(loop->run(move_by(1.0, even_limits(2, 2.1, 20.0, 200.0))));
            }),
            ErrorCode::kVelocityLimit);
  EXPECT_FALSE(loop->busy());
  EXPECT_EQ(loop->position(), JointVector::Zero(2));
  EXPECT_TRUE(loop->run(move_by(1.0, kLimits))->wait(20.0));
}

TEST(ControllerLoop, RefusesASecondRunWhileOneIsUnderWay) {
  const auto loop = virtual_loop();
  loop->set_override(0.0);
  const auto job = loop->run(move_by(1.0, kLimits));
  EXPECT_TRUE(loop->busy());
  EXPECT_EQ(code_of([&] { static_cast<void>(loop->run(move_by(1.0, kLimits))); }),
            ErrorCode::kBusy);
  EXPECT_FALSE(job->wait(0.02));
  loop->set_override(1.0);
  EXPECT_TRUE(job->wait(20.0));
  EXPECT_TRUE(loop->run(move_by(-1.0, kLimits, 1.0))->wait(20.0));
}

TEST(ControllerLoop, RefusesAnOverrideOutsideZeroToOne) {
  const auto loop = virtual_loop();
  for (const double share : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(code_of([&] { loop->set_override(share); }), ErrorCode::kBadArgument);
  }
  EXPECT_EQ(loop->override_share(), 1.0);
}

TEST(ControllerLoop, AStoppedRunRestsOnItsPathAndTheNextStartsThere) {
  const auto loop = virtual_loop();
  const auto trajectory = move_by(50.0, kLimits);
  const auto job = loop->run(trajectory);
  while (job->nominal_time() < 1.0) std::this_thread::yield();
  job->stop();
  job->resume();  // too late
  ASSERT_TRUE(job->wait(20.0));
  const LogRecord last = job->log().back();
  // Virtual time is quick: the end may come before the stop.
  EXPECT_EQ(last.q, trajectory->at(last.nominal_time).q);
  EXPECT_TRUE(last.qd.isZero(0.0));
  EXPECT_EQ(loop->position(), last.q);
  const auto next = loop->run(move_by(0.5, kLimits, last.q[0]));
  EXPECT_TRUE(next->wait(20.0));
}

TEST(ControllerLoop, PausesAndResumes) {
  ControllerLoop loop(std::make_unique<SimulatedDrive>(JointVector::Zero(2)), kLimits);
  const auto job = loop.run(move_by(1.0, kLimits));
  while (job->nominal_time() < 0.1) std::this_thread::sleep_for(milliseconds(1));
  job->pause();
  for (int i = 0; job->state() != RunState::kPaused && i < 2000; ++i) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  ASSERT_EQ(job->state(), RunState::kPaused);
  EXPECT_FALSE(job->wait(0.01));
  job->resume();
  ASSERT_TRUE(job->wait(20.0));
  EXPECT_EQ(job->state(), RunState::kFinished);
}

TEST(ControllerLoop, DestructionBringsARunToRestFirst) {
  const auto history = std::make_shared<DriveHistory>();
  std::shared_ptr<Job> job;
  const auto trajectory = move_by(5.0, kLimits);
  {
    ControllerLoop loop(std::make_unique<WatchedDrive>(history), kLimits);
    EXPECT_EQ(history->enabled, 1);
    job = loop.run(trajectory);
    while (job->nominal_time() < 0.3) std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_EQ(job->state(), RunState::kStopped);
  EXPECT_TRUE(history->last_qd.isZero(0.0));
  EXPECT_EQ(history->released, 1);
  const LogRecord last = job->log().back();
  EXPECT_EQ(last.q, trajectory->at(last.nominal_time).q);
  EXPECT_LT(last.nominal_time, trajectory->duration());
}

TEST(ControllerLoop, ADriveThatFailsEndsTheRunWithItsMessage) {
  const auto history = std::make_shared<DriveHistory>();
  const auto loop = virtual_loop(std::make_unique<WatchedDrive>(history));
  loop->set_override(0.001);
  const auto job = loop->run(move_by(1.0, kLimits));
  history->failing = true;
  try {
    job->wait(20.0);
    FAIL() << "the fault was swallowed";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kDriveFault);
    EXPECT_EQ(error.problem().message, "joint 2 is too hot");
    EXPECT_EQ(error.problem().time, job->nominal_time());
  }
  EXPECT_EQ(job->state(), RunState::kFault);
  EXPECT_EQ(job->log().back().state, RunState::kFault);
  EXPECT_FALSE(loop->busy());
  EXPECT_EQ(code_of([&] { static_cast<void>(loop->run(move_by(1.0, kLimits))); }),
            ErrorCode::kDriveFault);
  const std::uint64_t exchanges = history->exchanges;
  std::this_thread::sleep_for(milliseconds(5));
  EXPECT_EQ(history->exchanges, exchanges) << "the failed drive was spoken to again";
}

TEST(ControllerLoop, ADriveThatFailsWhileAMotionIsAdmittedEndsThatRun) {
  // The fault may fall anywhere between the look at the drive and the first cycle of the motion.
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    auto history = std::make_shared<DriveHistory>();
    auto loop = virtual_loop(std::make_unique<WatchedDrive>(history));
    loop->set_override(0.001);  // the fault comes before its end
    std::thread saboteur([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(5 * trial));
      history->failing = true;
    });
    std::shared_ptr<Job> job;
    try {
      job = loop->run(move_by(1.0, kLimits));
    } catch (const MotionError& error) {
      EXPECT_EQ(error.code(), ErrorCode::kDriveFault);
    }
    saboteur.join();
    if (job != nullptr) {
      EXPECT_EQ(code_of([&] { (void)job->wait(10.0); }), ErrorCode::kDriveFault);
      EXPECT_EQ(job->state(), RunState::kFault);
    }
  }
}

TEST(ControllerLoop, TheNextRunMayFollowAsSoonAsOneShowsItsEnd) {
  auto loop = virtual_loop();
  for (int trial = 0; trial < 30; ++trial) {
    SCOPED_TRACE(trial);
    const double from = trial % 2 == 0 ? 0.0 : 0.1;
    const auto job = loop->run(move_by(trial % 2 == 0 ? 0.1 : -0.1, kLimits, from));
    while (job->state() != RunState::kFinished) std::this_thread::yield();
  }
}

TEST(ControllerLoop, ADriveOfOtherJointsIsRefused) {
  EXPECT_EQ(code_of([] { virtual_loop(std::make_unique<SimulatedDrive>(JointVector::Zero(3))); }),
            ErrorCode::kBadArgument);
  EXPECT_EQ(code_of([] { virtual_loop(nullptr); }), ErrorCode::kBadArgument);
}

TEST(ControllerLoop, WithoutItsThreadsItRefusesAndReleasesTheDrive) {
  for (const int allowed : {0, 1}) {
    SCOPED_TRACE(allowed);
    const auto history = std::make_shared<DriveHistory>();
    const ThreadShortage shortage(allowed);
    try {
      virtual_loop(std::make_unique<WatchedDrive>(history));
      FAIL() << "there is a loop without its thread";
    } catch (const MotionError& error) {
      EXPECT_EQ(error.code(), ErrorCode::kDriveFault);
      EXPECT_NE(error.problem().message.find("temporarily unavailable"), std::string::npos)
          << error.problem().message;
      EXPECT_FALSE(error.problem().ways_out.empty());
    }
    EXPECT_EQ(history->enabled, 1);
    EXPECT_EQ(history->released, 1);
    EXPECT_EQ(history->exchanges, 0U);
  }
  const ThreadShortage enough(2);
  EXPECT_TRUE(virtual_loop()->run(move_by(1.0, kLimits))->wait(20.0));
}

TEST(ControllerLoop, CommandsFromManyThreadsLeaveTheRunOnItsPath) {
  const auto loop = virtual_loop();
  const auto trajectory = move_by(40.0, kLimits);
  const auto job = loop->run(trajectory);
  std::atomic<bool> done{false};
  const auto pester = [&](int who) {
    for (int i = 0; !done; ++i) {
      if (who == 0) loop->set_override(0.5 + 0.5 * (i % 2));
      if (who == 1) i % 2 == 0 ? job->pause() : job->resume();
      if (who == 2) {
        EXPECT_LE(loop->measured().q.norm(), 100.0);
      }
      if (who == 3) {
        EXPECT_LE(job->log().size() + job->overruns(), 1'000'000U);
      }
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    job->resume();
  };
  {
    std::vector<std::jthread> threads;
    for (int who = 0; who < 4; ++who) threads.emplace_back(pester, who);
    std::this_thread::sleep_for(milliseconds(200));
    done = true;
  }
  job->resume();
  loop->set_override(1.0);
  ASSERT_TRUE(job->wait(60.0));
  EXPECT_EQ(job->state(), RunState::kFinished);
  for (const LogRecord& record : job->log()) {
    ASSERT_EQ(record.q, trajectory->at(record.nominal_time).q);
  }
}

}  // namespace
}  // namespace viapoint
