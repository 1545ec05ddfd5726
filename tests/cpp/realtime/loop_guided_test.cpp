// A hand moves the arm: the loop follows it, and leads it again from where it was left.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/virtual_loop.hpp"

namespace viapoint {
namespace {

const JointLimits kLimits = even_limits(2, 2.0, 20.0, 200.0);

struct Cell {
  std::shared_ptr<GuidingHand> hand = std::make_shared<GuidingHand>();
  VirtualLoop loop{std::make_unique<SimulatedDrive>(JointVector::Zero(2), nullptr,
                                                    SimulatedDriveOptions{}, hand),
                   kLimits};

  [[nodiscard]] std::shared_ptr<const Trajectory> motion_from(const JointVector& q) const {
    std::vector<TrajectoryPiece> pieces;
    append_straight(pieces, q, JointVector::Constant(2, 5.0), kLimits, 0);
    return std::make_shared<Trajectory>(std::move(pieces), kLimits);
  }
};

std::vector<JointVector> way(int cycles, double step) {
  std::vector<JointVector> positions;
  for (int k = 0; k < cycles; ++k) positions.push_back(JointVector::Constant(2, step * k));
  return positions;
}

ErrorCode code_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const MotionError& error) {
    return error.code();
  }
  return ErrorCode::kInternal;
}

TEST(GuidedLoop, FollowsTheHandAndLeadsTheArmFromWhereItWasLeft) {
  Cell cell;
  cell.hand->guide(way(200, 0.002));
  EXPECT_EQ(cell.loop.pass(50), 50);
  EXPECT_TRUE(cell.loop.guided());
  EXPECT_DOUBLE_EQ(cell.loop.measured().q[0], 0.002 * 49);
  EXPECT_DOUBLE_EQ(cell.loop.position()[0], 0.002 * 48);
  EXPECT_EQ(
      code_of([&] { static_cast<void>(cell.loop.run(cell.motion_from(cell.loop.position()))); }),
      ErrorCode::kBusy);
  EXPECT_EQ(code_of([&] { cell.loop.jog(JointVector::Constant(2, 0.1)); }), ErrorCode::kBusy);

  EXPECT_EQ(cell.loop.pass(1000), 151);
  EXPECT_FALSE(cell.loop.guided());
  const JointVector left = JointVector::Constant(2, 0.002 * 199);
  EXPECT_EQ(cell.loop.position(), left);
  const auto job = cell.loop.run(cell.motion_from(left));
  while (!job->wait(0.0)) cell.loop.pass(100);
  EXPECT_EQ(job->state(), RunState::kFinished);
  EXPECT_NEAR(cell.loop.measured().q[1], left[1] + 5.0, 1e-12);
  EXPECT_EQ(cell.loop.fault(), "");
}

TEST(GuidedLoop, IsTakenByAHandOnlyWhereNothingElseMovesTheArm) {
  Cell cell;
  int hands = 0;
  const auto take = [&](const Measurement& now) {
    ++hands;
    cell.hand->guide(std::vector<JointVector>(100, now.q));
  };
  const auto refusal = [&] { return code_of([&] { cell.loop.admit_hand(take); }); };
  cell.loop.jog(JointVector::Constant(2, 0.1));
  EXPECT_EQ(refusal(), ErrorCode::kBusy);  // wished, and not begun
  cell.loop.pass(10);
  EXPECT_EQ(refusal(), ErrorCode::kBusy);
  while (cell.loop.jogging()) cell.loop.pass(1);

  const auto job = cell.loop.run(cell.motion_from(cell.loop.position()));
  EXPECT_EQ(refusal(), ErrorCode::kBusy);
  cell.loop.pass(10);
  job->pause();
  while (job->state() != RunState::kPaused) cell.loop.pass(1);
  EXPECT_EQ(refusal(), ErrorCode::kBusy);
  job->stop();
  while (!job->wait(0.0)) cell.loop.pass(1);
  EXPECT_EQ(hands, 0);

  cell.loop.admit_hand(take);
  // At once, before a cycle has seen it.
  EXPECT_TRUE(cell.loop.guided());
  EXPECT_EQ(
      code_of([&] { static_cast<void>(cell.loop.run(cell.motion_from(cell.loop.position()))); }),
      ErrorCode::kBusy);
  EXPECT_EQ(code_of([&] { cell.loop.jog(JointVector::Constant(2, 0.1)); }), ErrorCode::kBusy);
  EXPECT_EQ(refusal(), ErrorCode::kBusy);  // of the hand itself
  EXPECT_EQ(cell.loop.pass(1000), 101);
  EXPECT_FALSE(cell.loop.guided());
  EXPECT_EQ(cell.loop.fault(), "");
}

TEST(GuidedLoop, TellsACycleByItsStamp) {
  Cell cell;
  cell.loop.pass(1);
  const std::int64_t first = cell.loop.newest_cycle().stamp;
  cell.hand->guide(way(10, 0.001));
  cell.loop.pass(1);
  EXPECT_EQ(cell.loop.newest_cycle().stamp, first + 2'000'000);
  cell.loop.pass(3);
  EXPECT_EQ(cell.loop.newest_cycle().stamp, first + 8'000'000);
  EXPECT_DOUBLE_EQ(cell.loop.newest_cycle().measurement.q[1], 0.003);
}

TEST(GuidedLoop, FailsWhereAHandTakesAnArmThatMoves) {
  Cell cell;
  const auto job = cell.loop.run(cell.motion_from(JointVector::Zero(2)));
  cell.loop.pass(100);
  cell.hand->guide(std::vector<JointVector>(1000, cell.loop.measured().q));
  for (int k = 0; k < 1000 && cell.loop.busy(); ++k) cell.loop.pass(1);
  EXPECT_EQ(job->state(), RunState::kFault);
  EXPECT_NE(cell.loop.fault().find("a hand guided the arm while it was told to move; the arm "
                                   "stopped on its path"),
            std::string::npos)
      << cell.loop.fault();
  EXPECT_FALSE(cell.loop.guided());
}

TEST(GuidedLoop, FailsWhereWhatIsMeasuredJumps) {
  Cell cell;
  std::vector<JointVector> positions = way(20, 0.001);
  positions[10][1] += 0.5;
  cell.hand->guide(std::move(positions));
  for (int k = 0; k < 20; ++k) cell.loop.pass(1);
  EXPECT_NE(cell.loop.fault().find("joint 2 was measured to jump"), std::string::npos)
      << cell.loop.fault();
}

}  // namespace
}  // namespace viapoint
