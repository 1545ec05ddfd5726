// What the loop does when the drive fails it, and how a run is released, stepped and taken back.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {
namespace {

const JointLimits kLimits = even_limits(2, 2.0, 20.0, 200.0);

/// What the test does to a drive, and sees of it when the loop has gone.
struct Bench {
  enum class Trouble { kNone, kSilent, kJump, kPower, kJumpThenPower };
  std::atomic<Trouble> trouble{Trouble::kNone};
  std::atomic<int> released{0};
  std::atomic<std::uint64_t> exchanges{0};
  JointVector last_qd = JointVector::Zero(2);
};

class BenchDrive final : public Drive {
 public:
  explicit BenchDrive(std::shared_ptr<Bench> bench)
      : bench_(std::move(bench)), arm_(JointVector::Zero(2)) {}
  [[nodiscard]] int joints() const override { return 2; }
  Measurement enable() override { return arm_.enable(); }
  DriveStatus exchange(const Setpoint& setpoint, Measurement& measurement) noexcept override {
    ++bench_->exchanges;
    bench_->last_qd = setpoint.qd;
    const Bench::Trouble trouble = bench_->trouble;
    if (trouble == Bench::Trouble::kSilent) return DriveStatus::kSilent;
    if (trouble == Bench::Trouble::kPower) return DriveStatus::kPowerLost;
    const DriveStatus status = arm_.exchange(setpoint, measurement);
    if (trouble == Bench::Trouble::kJump) measurement.q[1] += 0.3;
    if (trouble == Bench::Trouble::kJumpThenPower) {
      if (jumped_ > 5) return DriveStatus::kPowerLost;
      if (++jumped_ == 1) measurement.q[1] += 0.3;
    }
    return status;
  }
  void release() noexcept override { ++bench_->released; }

 private:
  std::shared_ptr<Bench> bench_;
  SimulatedDrive arm_;
  int jumped_ = 0;
};

struct Cell {
  std::shared_ptr<Bench> bench = std::make_shared<Bench>();
  std::shared_ptr<const Trajectory> trajectory;
  std::unique_ptr<ControllerLoop> loop;

  Cell() {
    std::vector<TrajectoryPiece> pieces;
    JointVector q = JointVector::Zero(2);
    for (int m = 0; m < 3; ++m) {
      append_straight(pieces, q, JointVector::Constant(2, 20.0), kLimits, m);
      q.array() += 20.0;
    }
    trajectory = std::make_shared<Trajectory>(std::move(pieces), kLimits);
    loop = std::make_unique<ControllerLoop>(std::make_unique<BenchDrive>(bench), kLimits,
                                            LoopOptions{}, std::make_unique<VirtualClock>());
  }
};

void await(const std::shared_ptr<Job>& job, RunState state) {
  for (int k = 0; k < 100'000 && job->state() != state; ++k) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  ASSERT_EQ(job->state(), state) << to_string(job->state());
}

/// Waits for what comes soon in virtual time, and fails where it never does.
template <typename Condition>
void await_that(const Condition& holds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!holds()) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline);
    std::this_thread::yield();
  }
}

std::string fault_of(const std::shared_ptr<Job>& job) {
  try {
    job->wait(20.0);
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kDriveFault);
    return error.problem().message;
  }
  ADD_FAILURE() << "the run did not fail";
  return {};
}

TEST(LoopFault, ADriveThatFallsSilentOrJumpsStopsTheArmOnItsPath) {
  for (const Bench::Trouble trouble : {Bench::Trouble::kSilent, Bench::Trouble::kJump}) {
    SCOPED_TRACE(static_cast<int>(trouble));
    Cell cell;
    const auto job = cell.loop->run(cell.trajectory);
    await_that([&] { return job->nominal_time() >= 0.5; });
    cell.bench->trouble = trouble;
    const std::string fault = fault_of(job);
    EXPECT_NE(fault.find(trouble == Bench::Trouble::kSilent ? "not answered" : "jump"),
              std::string::npos)
        << fault;
    EXPECT_NE(fault.find("on its path"), std::string::npos) << fault;
    EXPECT_EQ(fault, cell.loop->fault());
    const std::vector<LogRecord> last = cell.loop->fault_cycles();
    ASSERT_EQ(last.size(), static_cast<std::size_t>(ControllerLoop::kFaultCycles));
    EXPECT_EQ(last.back().state, RunState::kFault);
    for (const LogRecord& record : last) {
      EXPECT_EQ(record.q, cell.trajectory->at(record.nominal_time).q);
    }
    EXPECT_TRUE(last.back().qd.isZero(0.0));
    EXPECT_THROW(static_cast<void>(cell.loop->run(cell.trajectory)), MotionError);
    cell.loop.reset();
    EXPECT_TRUE(cell.bench->last_qd.isZero(0.0));
  }
}

TEST(LoopFault, APowerThatGoesIsReportedWithWhereTheArmWas) {
  Cell cell;
  const auto job = cell.loop->run(cell.trajectory);
  await_that([&] { return job->nominal_time() >= 0.5; });
  cell.bench->trouble = Bench::Trouble::kPower;
  const std::string fault = fault_of(job);
  EXPECT_NE(fault.find("category 0"), std::string::npos) << fault;
  EXPECT_NE(fault.find("measured last at"), std::string::npos) << fault;
  const std::uint64_t exchanges = cell.bench->exchanges;
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(cell.bench->exchanges, exchanges) << "nothing more is told a drive without power";
}

TEST(LoopFault, APowerThatGoesDuringTheGuardsStopIsNotToldAsAStop) {
  Cell cell;
  const auto job = cell.loop->run(cell.trajectory);
  await_that([&] { return job->nominal_time() >= 0.5; });
  cell.bench->trouble = Bench::Trouble::kJumpThenPower;
  const std::string fault = fault_of(job);
  EXPECT_NE(fault.find("jump"), std::string::npos) << fault;
  EXPECT_NE(fault.find("its power went"), std::string::npos) << fault;
  EXPECT_NE(fault.find("measured last at"), std::string::npos) << fault;
  EXPECT_EQ(fault.find("the arm stopped on"), std::string::npos) << fault;
  EXPECT_FALSE(cell.bench->last_qd.isZero(0.0)) << "the power was to go before the stop was over";
}

TEST(LoopStop, OfCategoryOneReleasesTheDriveAtRestAndOnce) {
  Cell cell;
  const auto job = cell.loop->run(cell.trajectory);
  await_that([&] { return job->nominal_time() >= 0.3; });
  job->stop(StopCategory::kRelease);
  ASSERT_TRUE(job->wait(20.0));
  EXPECT_EQ(job->state(), RunState::kStopped);
  EXPECT_EQ(cell.bench->released, 1);
  EXPECT_TRUE(job->log().back().qd.isZero(0.0));
  EXPECT_EQ(cell.loop->fault(), "");
  EXPECT_THROW(static_cast<void>(cell.loop->run(cell.trajectory)), MotionError);
  EXPECT_THROW(cell.loop->jog(JointVector::Zero(2)), MotionError);
  cell.loop.reset();
  EXPECT_EQ(cell.bench->released, 1);
}

TEST(LoopStop, OfCategoryOneGoesForOneOfCategoryTwoThatIsUnderWay) {
  Cell cell;
  const auto job = cell.loop->run(cell.trajectory);
  await_that([&] { return job->nominal_time() >= 0.3; });
  job->stop();
  job->stop(StopCategory::kRelease);
  job->resume();
  ASSERT_TRUE(job->wait(20.0));
  EXPECT_EQ(job->state(), RunState::kStopped);
}

TEST(LoopCommands, StepBackAndJogInAPauseAndEndWhereTheMotionEnds) {
  Cell cell;
  const auto job = cell.loop->run(cell.trajectory);
  job->step();
  await(job, RunState::kPaused);
  const double boundary = job->nominal_time();
  bool is_boundary = false;
  for (std::size_t p = 0; p < cell.trajectory->pieces().size(); ++p) {
    is_boundary = is_boundary || cell.trajectory->start_of(p) == boundary;
  }
  EXPECT_TRUE(is_boundary);
  job->backward();
  await_that([&] { return job->nominal_time() <= 0.0; });
  await(job, RunState::kPaused);
  EXPECT_THROW(cell.loop->jog(JointVector::Constant(2, 0.5)), MotionError)
      << "it was not paused by a wish";
  job->pause();
  cell.loop->jog(JointVector::Constant(2, 0.5));
  await_that([&] { return !cell.loop->jogging(); });
  EXPECT_GT(cell.loop->position().norm(), 0.01);
  job->resume();
  ASSERT_TRUE(job->wait(60.0));
  EXPECT_EQ(job->state(), RunState::kFinished);
  EXPECT_EQ(cell.loop->position(), cell.trajectory->at(cell.trajectory->duration()).q);
  bool returned = false;
  for (const LogRecord& record : job->log()) {
    returned = returned || record.state == RunState::kReturning;
  }
  EXPECT_TRUE(returned);
}

}  // namespace
}  // namespace viapoint
