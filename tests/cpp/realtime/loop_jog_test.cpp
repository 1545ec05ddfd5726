// Jogging through the loop, beside runs, faults and the end of the connection.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {
namespace {

const JointLimits kLimits = even_limits(2, 2.0, 20.0, 200.0);

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

/// What a drive was told; read after the loop has gone, but for the atomics.
struct History {
  std::atomic<bool> failing{false};
  std::atomic<double> fastest{0.0};
  Setpoint last;
  double hardest = 0.0;  ///< largest acceleration
};

class WatchedDrive final : public Drive {
 public:
  explicit WatchedDrive(std::shared_ptr<History> history)
      : history_(std::move(history)), arm_(JointVector::Zero(2)) {}
  [[nodiscard]] int joints() const override { return 2; }
  Measurement enable() override { return arm_.enable(); }
  DriveStatus exchange(const Setpoint& setpoint, Measurement& measurement) noexcept override {
    if (history_->failing) return DriveStatus::kFault;
    history_->last = setpoint;
    history_->fastest = std::max(history_->fastest.load(), setpoint.qd.cwiseAbs().maxCoeff());
    history_->hardest = std::max(history_->hardest, setpoint.qdd.cwiseAbs().maxCoeff());
    return arm_.exchange(setpoint, measurement);
  }
  void release() noexcept override {}
  [[nodiscard]] std::string fault() const override { return "joint 2 is too hot"; }

 private:
  std::shared_ptr<History> history_;
  SimulatedDrive arm_;
};

std::unique_ptr<ControllerLoop> loop_on(const std::shared_ptr<History>& history) {
  return std::make_unique<ControllerLoop>(std::make_unique<WatchedDrive>(history), kLimits,
                                          LoopOptions{}, std::make_unique<VirtualClock>());
}

void until_rest(const ControllerLoop& loop) {
  while (loop.jogging()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(LoopJog, TurnsTheJointsUntilTheWishIsOver) {
  const auto history = std::make_shared<History>();
  auto loop = loop_on(history);
  EXPECT_FALSE(loop->jogging());
  loop->jog(JointVector{{0.5, -0.25}});
  EXPECT_TRUE(loop->jogging());
  until_rest(*loop);
  const JointVector rest = loop->position();
  // 0.25 s of it, the way up to speed and the way to stop taken together as long as either.
  EXPECT_NEAR(rest[0], 0.5 * 0.252, 1e-9);
  EXPECT_NEAR(rest[1], -0.25 * 0.252, 1e-9);
  EXPECT_EQ(loop->jog_block(), "");
  loop.reset();
  EXPECT_EQ(history->fastest, 0.5);
  EXPECT_LE(history->hardest, 20.0);
}

TEST(LoopJog, ComesToRestBeforeTheConnectionEnds) {
  const auto history = std::make_shared<History>();
  auto loop = loop_on(history);
  loop->jog(JointVector{{1.0, 1.0}});
  while (history->fastest < 0.5) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  loop.reset();
  EXPECT_TRUE(history->last.qd.isZero(0.0));
  EXPECT_TRUE(history->last.qdd.isZero(0.0));
}

TEST(LoopJog, EndsWithADriveThatFails) {
  const auto history = std::make_shared<History>();
  auto loop = loop_on(history);
  loop->jog(JointVector{{1.0, 1.0}});
  while (history->fastest < 0.1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  history->failing = true;
  until_rest(*loop);
  EXPECT_EQ(code_of([&] { loop->jog(JointVector{{1.0, 1.0}}); }), ErrorCode::kDriveFault);
}

TEST(LoopJog, ExcludesRunsAndIsExcludedByThem) {
  const auto history = std::make_shared<History>();
  auto loop = loop_on(history);
  loop->jog(JointVector{{0.5, 0.5}});
  std::vector<TrajectoryPiece> early;
  append_straight(early, JointVector::Zero(2), JointVector::Constant(2, 0.5), kLimits, 0);
  const auto from_zero = std::make_shared<Trajectory>(std::move(early), kLimits);
  EXPECT_EQ(code_of([&] { (void)loop->run(from_zero); }), ErrorCode::kBusy);
  until_rest(*loop);
  // From where the jog ended, and nowhere else.
  EXPECT_EQ(code_of([&] { (void)loop->run(from_zero); }), ErrorCode::kNotAtStart);
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, loop->position(), JointVector::Constant(2, 0.5), kLimits, 0);
  loop->set_override(0.001);  // so that the run is there for as long as it is looked at
  const auto job = loop->run(std::make_shared<Trajectory>(std::move(pieces), kLimits));
  EXPECT_EQ(code_of([&] { loop->jog(JointVector{{0.5, 0.5}}); }), ErrorCode::kBusy);
  job->stop();
  ASSERT_TRUE(job->wait(20.0));
  loop->jog(JointVector{{-0.1, -0.1}});
  until_rest(*loop);
}

TEST(LoopJog, RefusesWrongVelocities) {
  auto loop = loop_on(std::make_shared<History>());
  EXPECT_EQ(code_of([&] { loop->jog(JointVector{{0.1}}); }), ErrorCode::kBadArgument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code_of([&] { loop->jog(JointVector{{0.1, nan}}); }), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of([&] { loop->jog(JointVector{{0.1, 2.1}}); }), ErrorCode::kVelocityLimit);
  EXPECT_FALSE(loop->jogging());
}

}  // namespace
}  // namespace viapoint
