#include "viapoint/trajectory/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "trajectory/trajectory_fixtures.hpp"

namespace viapoint {
namespace {

using testing::one_joint_piece;
using testing::smooth_move;
using testing::uniform_limits;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

static_assert(noexcept(TrajectoryPiece{}.at(0.0)), "the tick calls it");

JointLimits generous(int joints = 1) { return uniform_limits(joints, 100.0, 1e3, 1e4, 1e6); }

TEST(TrajectoryPiece, EvaluatesTheSmoothStepInClosedForm) {
  const TrajectoryPiece piece = smooth_move(1.0, 3.0, 2.0);
  const JointState middle = piece.at(1.0);
  EXPECT_DOUBLE_EQ(middle.q[0], 2.0);
  EXPECT_DOUBLE_EQ(middle.qd[0], 1.875);  // 15/8 Δ/T
  EXPECT_NEAR(middle.qdd[0], 0.0, 1e-14);
  EXPECT_DOUBLE_EQ(middle.qddd[0], -7.5);  // -30 Δ/T³
  const JointState start = piece.at(0.0);
  EXPECT_EQ(start.q[0], 1.0);
  EXPECT_EQ(start.qd[0], 0.0);
  EXPECT_EQ(start.qdd[0], 0.0);
  EXPECT_DOUBLE_EQ(start.qddd[0], 15.0);  // 60 Δ/T³
}

TEST(TrajectoryPiece, FollowsTheChainRuleThroughBothPolynomials) {
  // q = u³ and u = x² make q = x⁶ with x = τ/2.
  const TrajectoryPiece piece = one_joint_piece(2.0, {0, 0, 0, 1, 0, 0}, {0, 0, 1, 0, 0, 0});
  const double x = 0.6;
  const JointState state = piece.at(2.0 * x);
  EXPECT_NEAR(state.q[0], std::pow(x, 6), 1e-15);
  EXPECT_NEAR(state.qd[0], 6 * std::pow(x, 5) / 2, 1e-14);
  EXPECT_NEAR(state.qdd[0], 30 * std::pow(x, 4) / 4, 1e-14);
  EXPECT_NEAR(state.qddd[0], 120 * std::pow(x, 3) / 8, 1e-14);
}

TEST(TrajectoryPiece, EvaluatesAsManyJointsAsItHas) {
  TrajectoryPiece piece;
  piece.duration = 1.0;
  piece.timing = testing::kSteady;
  piece.joints = kMaxJoints;
  for (std::size_t i = 0; i < kMaxJoints; ++i) piece.path[1][i] = static_cast<double>(i);
  const JointState state = piece.at(0.5);
  ASSERT_EQ(state.q.size(), kMaxJoints);
  for (int i = 0; i < kMaxJoints; ++i) {
    EXPECT_DOUBLE_EQ(state.q[i], 0.5 * i);
    EXPECT_DOUBLE_EQ(state.qd[i], i);
  }
}

TEST(Trajectory, PutsPiecesOneAfterTheOther) {
  const Trajectory trajectory(
      {smooth_move(0, 1, 0.5), smooth_move(1, 2, 0.25), smooth_move(2, 0, 1.0)}, generous());
  EXPECT_EQ(trajectory.joints(), 1);
  EXPECT_DOUBLE_EQ(trajectory.duration(), 1.75);
  EXPECT_DOUBLE_EQ(trajectory.start_of(2), 0.75);
  EXPECT_NEAR(trajectory.at(0.625).q[0], 1.5, 1e-15);
  EXPECT_TRUE(trajectory.certificate().holds());
}

TEST(Trajectory, GivesAKnotToTheLaterPiece) {
  const Trajectory trajectory({smooth_move(0, 1, 0.5), smooth_move(1, 2, 0.25)}, generous());
  EXPECT_EQ(trajectory.piece_at(0.0), 0U);
  EXPECT_EQ(trajectory.piece_at(0.499), 0U);
  EXPECT_EQ(trajectory.piece_at(0.5), 1U);
  EXPECT_EQ(trajectory.piece_at(0.75), 1U);
}

TEST(Trajectory, ClampsTimeToItsEnds) {
  const Trajectory trajectory({smooth_move(-1, 1, 0.5), smooth_move(1, 2, 0.25)}, generous());
  EXPECT_EQ(trajectory.at(-5.0).q[0], -1.0);
  EXPECT_EQ(trajectory.at(1e9).q[0], 2.0);
  EXPECT_EQ(trajectory.piece_at(-5.0), 0U);
  EXPECT_EQ(trajectory.piece_at(1e9), 1U);
}

TEST(Trajectory, ReportsBrokenLimitsInsteadOfThrowing) {
  const Trajectory trajectory({smooth_move(0, 1, 0.5)}, uniform_limits(1, 100, 1.0, 1e3, 1e3));
  EXPECT_FALSE(trajectory.certificate().holds());
}

struct Refusal {
  std::string name;
  std::function<void(std::vector<TrajectoryPiece>&)> spoil;
  std::string says;
};

class TrajectoryRefusal : public ::testing::TestWithParam<Refusal> {};

TEST_P(TrajectoryRefusal, NamesWhatIsWrong) {
  std::vector<TrajectoryPiece> pieces = {smooth_move(0, 1, 0.5), smooth_move(1, 0, 0.5)};
  ASSERT_NO_THROW(Trajectory(pieces, generous()));
  GetParam().spoil(pieces);
  try {
    const Trajectory trajectory(pieces, generous());
    FAIL() << "accepted";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, TrajectoryRefusal,
    ::testing::Values(
        Refusal{"NoPieces", [](auto& p) { p.clear(); }, "at least one piece"},
        Refusal{"NoJoints", [](auto& p) { p[0].joints = 0; }, "piece 0"},
        Refusal{"NegativeJoints", [](auto& p) { p[1].joints = -1; }, "allowed are 1 to"},
        Refusal{"TooManyJoints", [](auto& p) { p[1].joints = kMaxJoints + 1; }, "allowed are 1 to"},
        Refusal{"DifferingJoints", [](auto& p) { p[1].joints = 2; }, "piece 1"},
        Refusal{"NoDuration", [](auto& p) { p[1].duration = 0.0; }, "lasts 0 s"},
        Refusal{"NegativeDuration", [](auto& p) { p[1].duration = -1.0; }, "lasts -1 s"},
        Refusal{"TinyDuration", [](auto& p) { p[0].duration = 3e-306; }, "at least 1e-30 s"},
        Refusal{"NanDuration", [](auto& p) { p[0].duration = kNan; }, "lasts nan s"},
        Refusal{"EndlessDuration",
                [](auto& p) { p[0].duration = std::numeric_limits<double>::infinity(); },
                "lasts inf s"},
        Refusal{"VastDuration", [](auto& p) { p[1].duration = 1e308; },
                "lasts 1e+308 s up to the end of its piece 1; allowed are up to 1e+12 s"},
        Refusal{"VastDurationOfAll", [](auto& p) { p[0].duration = p[1].duration = 6e11; },
                "lasts 1.2e+12 s up to the end of its piece 1; allowed are up to 1e+12 s"},
        Refusal{"NanPath", [](auto& p) { p[1].path[5][0] = kNan; }, "not a finite number"},
        Refusal{"InfiniteTiming",
                [](auto& p) { p[1].timing[2] = -std::numeric_limits<double>::infinity(); },
                "not a finite number"},
        Refusal{"TooManyOutputs", [](auto& p) { p[0].outputs = kMaxOutputsAPiece + 1; }, "outputs"},
        Refusal{"OutputBeyondTheLast",
                [](auto& p) {
                  p[0].outputs = 1;
                  p[0].output[0].index = 64;
                },
                "changes output 64; outputs are 0 to 63"},
        Refusal{"OutputBelowZero",
                [](auto& p) {
                  p[0].outputs = 1;
                  p[0].output[0].index = -1;
                },
                "changes output -1"}),
    [](const auto& refusal) { return refusal.param.name; });

TEST(Trajectory, RefusesLimitsOfAnotherArm) {
  try {
    const Trajectory trajectory({smooth_move(0, 1, 0.5)}, generous(2));
    FAIL() << "accepted";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
  }
}

TEST(Trajectory, RefusesLimitsThatAreNone) {
  JointLimits limits = generous();
  limits.jerk[0] = kNan;
  try {
    const Trajectory trajectory({smooth_move(0, 1, 0.5)}, limits);
    FAIL() << "accepted";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadLimits);
  }
}

}  // namespace
}  // namespace viapoint
