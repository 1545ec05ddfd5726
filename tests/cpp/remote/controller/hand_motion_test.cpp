// A hand that an operator lends takes the arm only where nothing else moves it.
#include "controller/hand_motion.hpp"

#include <gtest/gtest.h>

#include <barrier>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "remote/two_joint_arm.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/remote/control_seat.hpp"

namespace viapoint::controller {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::await;
using testing::move;

const JointLimits kLimits = testing::wide_limits();
constexpr std::size_t kLong = 30'000;
/// For others to do what they must not.
constexpr milliseconds kWhile{50};

/// An arm, its hand, and who has control of it.
struct Cell {
  ControllerLoop* loop = nullptr;
  std::shared_ptr<GuidingHand> hand = std::make_shared<GuidingHand>();
  HandMotion motion{hand};
  ArmHost host{
      kLimits,
      [this](const JointVector& rest) {
        const JointVector start = rest.size() == 0 ? JointVector(JointVector::Zero(2)) : rest;
        auto made = std::make_unique<ControllerLoop>(
            std::make_unique<SimulatedDrive>(start, nullptr, SimulatedDriveOptions{}, hand),
            kLimits);
        loop = made.get();
        return made;
      },
      seconds(60),
      {},
      [this] { hand->let_go(); }};
  std::string token = host.take_control("alice");

  /// Keeps the arm where it is, for a minute.
  void begin_hand() {
    motion.add(0, std::vector<JointVector>(kLong, host.status().measured));
    motion.begin(host, token);
  }
  [[nodiscard]] std::uint64_t begin_run() {
    host.add_pieces(token, 0, move(2.0, host.status().setpoint[0]));
    return host.run(token);
  }
};

/// What refuses the call; empty: nothing does.
std::string refusal_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const MotionError& error) {
    return std::string(to_string(error.code())) + ": " + error.problem().message;
  }
  return {};
}

TEST(HandMotion, IsGuidedFromTheBeginningAndRefusesRunsAndJogs) {
  Cell cell;
  cell.begin_hand();
  EXPECT_TRUE(cell.host.status().guided);
  EXPECT_EQ(refusal_of([&] { static_cast<void>(cell.begin_run()); }),
            "busy: the arm is guided by hand");
  EXPECT_EQ(refusal_of([&] { cell.host.jog(cell.token, JointVector::Constant(2, 0.1)); }),
            "busy: the arm is guided by hand");
  cell.motion.let_go();
  ASSERT_TRUE(await([&] { return !cell.host.status().guided; }));
  EXPECT_EQ(cell.host.status().fault, "");
}

TEST(HandMotion, WaitsForARunThatIsBeingAdmittedAndIsRefused) {
  Cell cell;
  std::string refusal;
  std::jthread other;
  const auto last_word = [&] {
    other = std::jthread([&] { refusal = refusal_of([&] { cell.begin_hand(); }); });
    std::this_thread::sleep_for(kWhile);
    EXPECT_FALSE(cell.hand->guides());
  };
  const auto job =
      cell.loop->run(std::make_shared<const Trajectory>(move(0.5), kLimits), last_word);
  other.join();
  EXPECT_EQ(refusal, "busy: a run is already under way");
  EXPECT_TRUE(job->wait(60.0));
  EXPECT_EQ(job->state(), RunState::kFinished);
  EXPECT_EQ(cell.host.status().fault, "");
}

TEST(HandMotion, BeginsOrARunOfTheSameInstantDoes) {
  Cell cell;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    std::barrier start(2);
    std::string run_refusal, hand_refusal;
    std::uint64_t run = 0;
    {
      const std::jthread other([&] {
        start.arrive_and_wait();
        hand_refusal = refusal_of([&] { cell.begin_hand(); });
      });
      start.arrive_and_wait();
      run_refusal = refusal_of([&] { run = cell.begin_run(); });
    }
    ASSERT_NE(run_refusal.empty(), hand_refusal.empty()) << run_refusal << ' ' << hand_refusal;
    if (run_refusal.empty()) {
      cell.host.steer(cell.token, run, Steering::kStop);
      EXPECT_TRUE(cell.host.job(run)->wait(60.0));
    }
    cell.motion.let_go();
    ASSERT_TRUE(await([&] { return !cell.host.status().guided && !cell.host.status().busy; }));
    ASSERT_EQ(cell.host.status().fault, "");
  }
}

TEST(HandMotion, TakesNoArmOfAnOperatorWhoHasLeftMeanwhile) {
  Cell cell;
  std::string refusal;
  std::jthread alice;
  const auto leave = [&] {
    // Nothing else is admitted meanwhile, so that her hand waits for her to have left.
    alice = std::jthread([&] { refusal = refusal_of([&] { cell.begin_hand(); }); });
    std::this_thread::sleep_for(kWhile);
    cell.host.give_up_control(cell.token);
    static_cast<void>(cell.host.take_control("bob"));
    throw NotInControl("enough");
  };
  EXPECT_THROW((void)cell.loop->run(std::make_shared<const Trajectory>(move(0.5), kLimits), leave),
               NotInControl);
  alice.join();
  EXPECT_NE(refusal, "");
  EXPECT_FALSE(cell.host.status().guided);
}

TEST(HandMotion, TakesNoArmWhoseDriveWasReleased) {
  Cell cell;
  cell.host.steer(cell.token, cell.begin_run(), Steering::kStopAndRelease);
  // At once, while the arm comes to rest, and from then on.
  std::string refusal;
  ASSERT_TRUE(await([&] {
    refusal = refusal_of([&] { cell.begin_hand(); });
    return !refusal.starts_with("busy");
  }));
  EXPECT_EQ(refusal, "drive_fault: the drive was released by a stop of category 1");
  EXPECT_FALSE(cell.host.status().guided);
}

TEST(HandMotion, IsOffAnArmThatHasFailed) {
  Cell cell;
  std::vector<JointVector> way(kLong, cell.host.status().measured);
  way[50] = JointVector::Constant(2, 0.5);  // farther than a joint goes in a cycle
  cell.motion.add(0, way);
  cell.motion.begin(cell.host, cell.token);
  ASSERT_TRUE(await([&] { return !cell.host.status().fault.empty(); }));
  EXPECT_FALSE(cell.host.status().guided);
  EXPECT_TRUE(refusal_of([&] { cell.begin_hand(); }).starts_with("drive_fault"));
}

}  // namespace
}  // namespace viapoint::controller
