#include "viapoint/remote/arm_host.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "remote/two_joint_arm.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/remote/control_seat.hpp"

namespace viapoint {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::await;
using testing::move;

const JointLimits kLimits = testing::wide_limits();

ArmHost::MakeLoop simulated() {
  return [](const JointVector& rest) {
    const JointVector start = rest.size() == 0 ? JointVector(JointVector::Zero(2)) : rest;
    return std::make_unique<ControllerLoop>(std::make_unique<SimulatedDrive>(start), kLimits);
  };
}

/// A drive whose power goes when it is told to, and that cannot be enabled for as long.
class WeakDrive final : public Drive {
 public:
  WeakDrive(const std::atomic<bool>& is_weak, const JointVector& start)
      : is_weak_(is_weak), simulated_(start) {}
  [[nodiscard]] int joints() const override { return 2; }
  Measurement enable() override {
    if (is_weak_) throw MotionError(ErrorCode::kDriveFault, "no power");
    return simulated_.enable();
  }
  [[nodiscard]] DriveStatus exchange(const Setpoint& setpoint,
                                     Measurement& measurement) noexcept override {
    return is_weak_ ? DriveStatus::kFault : simulated_.exchange(setpoint, measurement);
  }
  void release() noexcept override {}

 private:
  const std::atomic<bool>& is_weak_;
  SimulatedDrive simulated_;
};

/// An operator who beats from a thread of his own for as long as he lives.
class Operator {
 public:
  explicit Operator(ArmHost& host)
      : token(host.take_control("alice")), thread_([this, &host](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            try {
              host.beat(token);
            } catch (const NotInControl&) {
              return;
            }
            std::this_thread::sleep_for(milliseconds(5));
          }
        }) {}

  const std::string token;

 private:
  std::jthread thread_;
};

std::uint64_t run(ArmHost& host, const std::string& token, std::vector<TrajectoryPiece> pieces) {
  host.add_pieces(token, 0, std::move(pieces));
  return host.run(token);
}

TEST(ArmHost, RunsWhatItsOperatorAdds) {
  ArmHost host(kLimits, simulated(), seconds(60));
  const std::string token = host.take_control("alice");
  EXPECT_EQ(host.status().operator_name, "alice");
  const std::uint64_t number = run(host, token, move(0.5));
  EXPECT_EQ(number, 1U);
  EXPECT_TRUE(host.job(number)->wait(60.0));
  EXPECT_EQ(host.job(number)->state(), RunState::kFinished);
  EXPECT_EQ(host.status().setpoint, JointVector(JointVector::Constant(2, 1.0)));
}

TEST(ArmHost, RefusesWhoIsNotInControl) {
  ArmHost host(kLimits, simulated(), seconds(60));
  const std::string token = host.take_control("alice");
  const std::uint64_t number = run(host, token, move(0.5));
  for (const char* stranger : {"", "bob"}) {
    EXPECT_THROW(host.beat(stranger), NotInControl);
    EXPECT_THROW(host.add_pieces(stranger, 0, move(0.5)), NotInControl);
    EXPECT_THROW((void)host.run(stranger), NotInControl);
    EXPECT_THROW(host.steer(stranger, number, Steering::kStop), NotInControl);
    EXPECT_THROW(host.add_tools(stranger, number, {{}}), NotInControl);
    EXPECT_THROW(host.set_override(stranger, 0.5), NotInControl);
    EXPECT_THROW(host.jog(stranger, JointVector::Zero(2)), NotInControl);
    EXPECT_THROW(host.give_up_control(stranger), NotInControl);
  }
  EXPECT_THROW((void)host.take_control("bob"), NotInControl);
  EXPECT_TRUE(host.job(number)->wait(60.0));
  EXPECT_EQ(host.job(number)->state(), RunState::kFinished);
}

TEST(ArmHost, PausesTheRunOfAnOperatorWhoFallsSilentUntilTheNextOneResumesIt) {
  // Long enough that a loaded machine loses no beat.
  ArmHost host(kLimits, simulated(), seconds(1));
  std::uint64_t number = 0;
  {
    const Operator alice(host);
    number = run(host, alice.token, move(2.0));
    ASSERT_TRUE(await([&] { return host.job(number)->nominal_time() > 0.2; }));
  }
  const std::shared_ptr<Job> job = host.job(number);
  ASSERT_TRUE(await([&] { return job->state() == RunState::kPaused; }));
  EXPECT_EQ(host.status().operator_name, "");
  EXPECT_NE(host.status().control_loss.find("\"alice\""), std::string::npos);
  EXPECT_LT(job->nominal_time(), 2.0);

  const Operator bob(host);
  // Nothing goes on by itself.
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(job->state(), RunState::kPaused);
  EXPECT_THROW((void)run(host, bob.token, move(0.5)), MotionError);
  host.steer(bob.token, number, Steering::kResume);
  EXPECT_TRUE(job->wait(60.0));
  EXPECT_EQ(job->state(), RunState::kFinished);
}

TEST(ArmHost, EndsTheJogOfAnOperatorWhoFallsSilent) {
  ArmHost host(kLimits, simulated(), milliseconds(100));
  const std::string token = host.take_control("alice");
  // The calls go on, the beats never come.
  const auto may_jog = [&] {
    try {
      host.jog(token, JointVector::Constant(2, 0.01));
      return true;
    } catch (const NotInControl&) {
      return false;
    }
  };
  EXPECT_TRUE(await([&] { return !may_jog(); }));
  EXPECT_TRUE(await([&] { return !host.status().jogging; }));
}

TEST(ArmHost, PausesWhenControlIsGivenUp) {
  ArmHost host(kLimits, simulated(), seconds(60));
  const std::string token = host.take_control("alice");
  const std::uint64_t number = run(host, token, move(2.0));
  host.give_up_control(token);
  EXPECT_TRUE(await([&] { return host.job(number)->state() == RunState::kPaused; }));
  EXPECT_THROW(host.steer(token, number, Steering::kResume), NotInControl);
}

TEST(ArmHost, ProvesAMotionBeforeItMoves) {
  ArmHost host(kLimits, simulated(), seconds(60));
  const std::string token = host.take_control("alice");
  const auto refusal = [&](std::vector<TrajectoryPiece> pieces) {
    try {
      (void)run(host, token, std::move(pieces));
    } catch (const MotionError& error) {
      return std::string(to_string(error.code()));
    }
    return std::string("none");
  };
  EXPECT_EQ(refusal(move(0.05)), "jerk_limit");
  EXPECT_EQ(refusal(move(1.0, 0.1)), "not_at_start");
  EXPECT_EQ(refusal({}), "bad_argument");
  std::vector<TrajectoryPiece> broken = move(1.0);
  broken.front().path[2][0] = std::nan("");
  EXPECT_EQ(refusal(broken), "bad_argument");
  EXPECT_EQ(host.status().run, 0U);
  EXPECT_EQ(host.status().setpoint, JointVector(JointVector::Zero(2)));
}

TEST(ArmHost, HoldsAMotionToItsLargestNumberOfPieces) {
  ArmHost host(kLimits, simulated(), seconds(60));
  const std::string token = host.take_control("alice");
  const std::vector<TrajectoryPiece> many(ArmHost::kMaxPieces / 2, move(1.0).front());
  host.add_pieces(token, 0, many);
  host.add_pieces(token, many.size(), many);
  EXPECT_THROW(host.add_pieces(token, ArmHost::kMaxPieces, move(1.0)), MotionError);
  host.add_pieces(token, 0, move(0.5));
  EXPECT_TRUE(host.job(host.run(token))->wait(60.0));
}

TEST(ArmHost, RefusesAPartThatIsMissingOrComesTwice) {
  ArmHost host(kLimits, simulated(), seconds(60));
  const std::string token = host.take_control("alice");
  host.add_pieces(token, 0, move(0.5));
  host.add_pieces(token, 1, move(0.5, 1.0));
  EXPECT_THROW(host.add_pieces(token, 1, move(0.5, 1.0)), MotionError);
  EXPECT_THROW(host.add_pieces(token, 3, move(0.5, 2.0)), MotionError);
  EXPECT_TRUE(host.job(host.run(token))->wait(60.0));
  EXPECT_EQ(host.status().setpoint, JointVector(JointVector::Constant(2, 2.0)));
  EXPECT_THROW(host.add_pieces(token, 2, move(0.5, 2.0)), MotionError);
}

TEST(ArmHost, BeginsNothingThatWasProvenForAnOperatorWhoHasLeft) {
  ControllerLoop* loop = nullptr;
  ArmHost host(
      kLimits,
      [&loop](const JointVector& rest) {
        auto made = simulated()(rest);
        loop = made.get();
        return made;
      },
      seconds(60));
  const std::string token = host.take_control("alice");
  host.add_pieces(token, 0, move(0.5));
  std::jthread alice;
  bool was_refused = false;
  const auto leave = [&] {
    // Nothing else is admitted meanwhile, so that hers waits for her to have left.
    alice = std::jthread([&] {
      try {
        (void)host.run(token);
      } catch (const NotInControl&) {
        was_refused = true;
      }
    });
    std::this_thread::sleep_for(milliseconds(50));
    host.give_up_control(token);
    (void)host.take_control("bob");
    throw NotInControl("enough");
  };
  EXPECT_THROW((void)loop->run(std::make_shared<const Trajectory>(move(0.5), kLimits), leave),
               NotInControl);
  alice.join();
  EXPECT_TRUE(was_refused);
  EXPECT_EQ(host.status().run, 0U);
  EXPECT_FALSE(host.status().busy);
}

TEST(ArmHost, ForgetsOldRunsByTheirNumber) {
  ArmHost host(kLimits, simulated(), seconds(60));
  const std::string token = host.take_control("alice");
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(host.job(run(host, token, move(0.5, k)))->wait(60.0));
  }
  EXPECT_EQ(host.job(3)->state(), RunState::kFinished);
  EXPECT_EQ(host.job(2)->state(), RunState::kFinished);
  EXPECT_THROW((void)host.job(1), MotionError);
  EXPECT_THROW((void)host.job(4), MotionError);
}

TEST(ArmHost, TheNextOperatorEnablesTheDriveAgain) {
  std::atomic<bool> is_weak{false};
  ArmHost host(
      kLimits,
      [&](const JointVector& rest) {
        const JointVector start = rest.size() == 0 ? JointVector(JointVector::Zero(2)) : rest;
        return std::make_unique<ControllerLoop>(std::make_unique<WeakDrive>(is_weak, start),
                                                kLimits);
      },
      seconds(60));
  const std::string alice = host.take_control("alice");
  const std::uint64_t number = run(host, alice, move(2.0));
  ASSERT_TRUE(await([&] { return host.job(number)->nominal_time() > 0.2; }));
  is_weak = true;
  ASSERT_TRUE(await([&] { return !host.status().fault.empty(); }));
  EXPECT_THROW(host.jog(alice, JointVector::Zero(2)), MotionError);
  host.give_up_control(alice);

  EXPECT_THROW((void)host.take_control("bob"), MotionError);
  EXPECT_EQ(host.status().fault, "no power");
  EXPECT_EQ(host.status().operator_name, "");
  is_weak = false;
  const std::string bob = host.take_control("bob");
  EXPECT_EQ(host.status().fault, "");
  const double here = host.status().setpoint[0];
  EXPECT_GT(here, 0.0);
  EXPECT_TRUE(host.job(run(host, bob, move(0.5, here)))->wait(60.0));
}

TEST(ArmHost, KeepsNobodyWaitingWhileADriveIsEnabledForAnother) {
  std::atomic<bool> is_weak{false}, may_go_on{true}, is_enabling{false};
  ArmHost host(
      kLimits,
      [&](const JointVector& rest) {
        is_enabling = true;
        EXPECT_TRUE(await([&] { return may_go_on.load(); }));
        const JointVector start = rest.size() == 0 ? JointVector(JointVector::Zero(2)) : rest;
        return std::make_unique<ControllerLoop>(std::make_unique<WeakDrive>(is_weak, start),
                                                kLimits);
      },
      seconds(60));
  is_weak = true;
  ASSERT_TRUE(await([&] { return !host.status().fault.empty(); }));
  is_weak = false;
  is_enabling = may_go_on = false;
  std::jthread alice([&] { (void)host.take_control("alice"); });
  ASSERT_TRUE(await([&] { return is_enabling.load(); }));
  EXPECT_THROW((void)host.take_control("bob"), NotInControl);
  EXPECT_EQ(host.status().operator_name, "");
  may_go_on = true;
  alice.join();
  EXPECT_EQ(host.status().operator_name, "alice");
}

TEST(ArmHost, AReleasedDriveIsEnabledForTheNextOperator) {
  ArmHost host(kLimits, simulated(), seconds(60));
  const std::string alice = host.take_control("alice");
  const std::uint64_t number = run(host, alice, move(2.0));
  host.steer(alice, number, Steering::kStopAndRelease);
  EXPECT_TRUE(host.job(number)->wait(60.0));
  EXPECT_THROW(host.jog(alice, JointVector::Zero(2)), MotionError);
  host.give_up_control(alice);
  const std::string bob = host.take_control("bob");
  EXPECT_TRUE(host.job(run(host, bob, move(0.5, host.status().setpoint[0])))->wait(60.0));
}

TEST(ArmHost, ShutsDownOnThePath) {
  std::shared_ptr<Job> job;
  {
    ArmHost host(kLimits, simulated(), seconds(60));
    const std::string token = host.take_control("alice");
    job = host.job(run(host, token, move(2.0)));
    host.shut_down();
    EXPECT_EQ(job->state(), RunState::kStopped);
    EXPECT_THROW((void)run(host, token, move(0.5)), NotInControl);
    EXPECT_THROW((void)host.take_control("bob"), NotInControl);
  }
  EXPECT_LT(job->nominal_time(), 2.0);
}

}  // namespace
}  // namespace viapoint
