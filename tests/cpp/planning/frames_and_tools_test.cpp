#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "planning/planner_fixture.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;
using Eigen::Vector3d;

constexpr Zone kRadius20{ZoneKind::kRadius, 0.02};

Pose pose_at(const Vector3d& position, const Vector3d& turn) {
  Pose pose(Eigen::Translation3d(position.x(), position.y(), position.z()));
  pose.linear() = rotation_exp(turn);
  return pose;
}

class FramesAndTools : public testing::Test {
 protected:
  RobotPtr puma_ = robot("puma560");
  MotionPlanner planner_{puma_};
  JointVector start_ = degrees({0, 45, 0, 0, 60, 0});
  Pose table_ = pose_at({0.4, -0.2, 0.1}, {0.1, -0.2, 0.7});
  Pose gripper_ = pose_at({0.02, 0.0, 0.15}, {0.0, 0.3, 0.0});

  [[nodiscard]] Pose here() const { return puma_->forward().pose(start_); }
  /// The start's pose, shifted in the base frame.
  [[nodiscard]] Pose shifted(double x, double y, double z) const {
    Pose pose = here();
    pose.translation() += Vector3d(x, y, z);
    return pose;
  }
  Script script() { return {*puma_, start_}; }
};

/// Every kind of move that tells a pose, a position or an axis, in the frame given; what it tells
/// is the same place whatever the frame.
Script all_moves(Script script, const Pose& pose_base_frame, const std::vector<Pose>& at) {
  const Pose to = pose_base_frame.inverse();
  const auto pose = [&](size_t i) { return PoseTarget{to * at[i]}; };
  const auto point = [&](size_t i) { return PositionTarget{to * at[i].translation()}; };
  script.add(SetFrame{pose_base_frame, "table"});
  script.add(PtpMove{pose(0)}, {{}, {}, {}, kRadius20});
  script.add(LinMove{pose(1)}, {{}, {}, {}, kRadius20});
  script.add(CircMove{point(2), pose(3)}, {{}, {}, {}, kRadius20});
  script.add(TurnMove{Vector3d(to * Vector3d(at[3].translation() + Vector3d(0.05, 0.0, 0.0))),
                      Vector3d(to.linear() * Vector3d::UnitZ()), 1.0, 0.0});
  SplineMove spline;
  spline.points = {pose(4), pose(5)};
  script.add(spline);
  return script;
}

TEST_F(FramesAndTools, MovesInAFrameAreTheMovesInTheBase) {
  const std::vector<Pose> at = {shifted(0.05, 0.0, 0.02),  shifted(0.05, 0.1, 0.02),
                                shifted(0.08, 0.15, 0.02), shifted(0.05, 0.2, 0.02),
                                shifted(0.0, 0.2, -0.05),  shifted(-0.05, 0.1, 0.0)};
  const PlannedMotion in_base = planner_.plan(all_moves(script(), Pose::Identity(), at).program());
  const PlannedMotion in_frame = planner_.plan(all_moves(script(), table_, at).program());
  ASSERT_EQ(in_base.corners.size(), in_frame.corners.size());
  for (const CornerOutcome& corner : in_frame.corners) EXPECT_FALSE(corner.stopped);
  EXPECT_NEAR(in_frame.trajectory.duration(), in_base.trajectory.duration(), 1e-6);
  for (double share = 0.0; share <= 1.0; share += 0.01) {
    const JointVector a = in_base.trajectory.at(share * in_base.trajectory.duration()).q;
    const JointVector b = in_frame.trajectory.at(share * in_frame.trajectory.duration()).q;
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-6) << share;
  }
}

TEST_F(FramesAndTools, AFrameMayChangeInABlend) {
  Script moves = script();
  moves.movel(shifted(0.0, 0.1, 0.0), kRadius20);
  moves.add(SetFrame{table_, "table"});
  moves.movel(table_.inverse() * shifted(0.1, 0.1, 0.0), kRadius20);
  moves.add(SetFrame{});
  moves.movel(shifted(0.1, 0.1, 0.1));
  const PlannedMotion motion = planner_.plan(moves.program());
  ASSERT_EQ(motion.corners.size(), 2U);
  for (const CornerOutcome& corner : motion.corners) {
    EXPECT_FALSE(corner.stopped) << corner.reason;
    EXPECT_GT(corner.used, 0.019);
  }
  const Pose end = puma_->forward().pose(motion.trajectory.at(motion.trajectory.duration()).q);
  EXPECT_LT((end.matrix() - shifted(0.1, 0.1, 0.1).matrix()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(FramesAndTools, MovesWithAnotherToolBringThatTool) {
  const RobotPtr gripping = puma_->with_tool(gripper_);
  const Pose from = gripping->forward().pose(start_);
  Pose to = from;
  to.translation() += Vector3d(0.0, 0.15, 0.05);
  Script moves = script();
  moves.add(SetTool{gripper_, "gripper"}).movel(to);
  const PlannedMotion motion = planner_.plan(moves.program());
  const Vector3d way = to.translation() - from.translation();
  for (double share = 0.0; share <= 1.0; share += 0.01) {
    const JointVector q = motion.trajectory.at(share * motion.trajectory.duration()).q;
    const Vector3d off = gripping->forward().pose(q).translation() - from.translation();
    EXPECT_LT(off.cross(way.normalized()).norm(), 5e-5) << share;
    EXPECT_LT(rotation_distance(gripping->forward().pose(q).linear(), from.linear()), 2e-4);
  }
  const JointVector end = motion.trajectory.at(motion.trajectory.duration()).q;
  EXPECT_LT((gripping->forward().pose(end).matrix() - to.matrix()).cwiseAbs().maxCoeff(), 1e-9);
  // The same as a program for the arm that has this tool.
  Script same(*gripping, start_);
  same.movel(to);
  const PlannedMotion other = MotionPlanner(gripping).plan(same.program());
  EXPECT_DOUBLE_EQ(other.trajectory.duration(), motion.trajectory.duration());
  EXPECT_DOUBLE_EQ(other.trajectory.certificate().manipulability,
                   motion.trajectory.certificate().manipulability);
}

TEST_F(FramesAndTools, TheArmStopsWhereTheToolChangesAndTheReportSaysSo) {
  const RobotPtr gripping = puma_->with_tool(gripper_);
  const Pose corner = shifted(0.0, 0.1, 0.0);
  Script moves = script();
  moves.movel(corner, kRadius20);
  moves.add(SetTool{gripper_, "gripper"});
  const JointVector at_corner = puma_->inverse().solve_near(corner, start_);
  Pose on = gripping->forward().pose(at_corner);
  on.translation() += Vector3d(0.1, 0.0, 0.0);
  moves.movel(on, kRadius20);
  on.translation() += Vector3d(0.0, 0.0, 0.1);
  moves.movel(on);
  const PlannedMotion motion = planner_.plan(moves.program());
  ASSERT_EQ(motion.corners.size(), 2U);
  EXPECT_EQ(motion.corners[0].move, 0);
  EXPECT_TRUE(motion.corners[0].stopped);
  EXPECT_EQ(motion.corners[0].reason, "the tool changes at this point");
  EXPECT_FALSE(motion.corners[1].stopped) << motion.corners[1].reason;
  ASSERT_EQ(motion.report.problems.size(), 1U);
  EXPECT_EQ(motion.report.problems[0].code, ErrorCode::kZoneIsStop);
  EXPECT_EQ(motion.report.problems[0].line, 1);
  bool rests = false;
  for (const TrajectoryPiece& piece : motion.trajectory.pieces()) {
    const JointState end = piece.at(piece.duration);
    rests = rests || ((end.q - at_corner).norm() < 1e-6 && end.qd.norm() < 1e-9);
  }
  EXPECT_TRUE(rests);
}

TEST_F(FramesAndTools, TheSameToolAgainStopsNothing) {
  Script moves = script();
  moves.movel(shifted(0.0, 0.1, 0.0), kRadius20);
  moves.add(SetTool{});
  moves.movel(shifted(0.1, 0.1, 0.0), kRadius20);
  moves.add(SetTool{puma_->description().tool, "as it was"});
  moves.movel(shifted(0.1, 0.1, 0.1));
  for (const CornerOutcome& corner : planner_.plan(moves.program()).corners) {
    EXPECT_FALSE(corner.stopped) << corner.reason;
  }
}

TEST_F(FramesAndTools, ATimedMotionMayHaveAFrameAndATool) {
  const RobotPtr gripping = puma_->with_tool(gripper_);
  const Pose from = gripping->forward().pose(start_);
  Pose to = from;
  to.translation() += Vector3d(0.0, 0.1, 0.0);
  const Pose into = table_.inverse();
  Script moves = script();
  moves.add(SetFrame{table_, "table"}).add(SetTool{gripper_, "gripper"});
  moves.add(TimedMove{
      {{PoseTarget{into * from}, 0.0}, {PoseTarget{into * to}, 1.0}}, 0.2, TimedSpace::kCartesian});
  const PlannedMotion motion = planner_.plan(moves.program());
  ASSERT_FALSE(motion.trajectory.pieces().empty());
  const JointVector end = motion.trajectory.at(motion.trajectory.duration()).q;
  EXPECT_LT((gripping->forward().pose(end).translation() - to.translation()).norm(), 1e-6);
}

TEST_F(FramesAndTools, JointsWithoutKinematicsHaveNoTool) {
  const RobotPtr joints = RobotModel::joint_robot(puma_->limits());
  Script moves(*joints, start_);
  moves.add(SetFrame{table_, "table"}).add(SetTool{gripper_, "gripper"});
  moves.movej(start_ + JointVector::Constant(6, 0.1));
  const Report report = MotionPlanner(joints).check(moves.program());
  ASSERT_EQ(report.problems.size(), 1U);
  EXPECT_EQ(report.problems[0].code, ErrorCode::kUncontrolled);
  EXPECT_EQ(report.problems[0].move, 1);
}

TEST_F(FramesAndTools, AnArmPlacedElsewhereMovesTheSame) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const Pose base = pose_at({uniform(random), uniform(random), uniform(random)},
                              {uniform(random), uniform(random), 3.0 * uniform(random)});
    const RobotPtr placed = puma_->with_base(base);
    EXPECT_EQ(placed->inverse().family(), puma_->inverse().family());
    Script at_origin = script();
    at_origin.movel(shifted(0.05, 0.1, 0.0), kRadius20).movel(shifted(0.05, 0.1, 0.1));
    Script elsewhere(*placed, start_);
    elsewhere.movel(base * shifted(0.05, 0.1, 0.0), kRadius20);
    elsewhere.movel(base * shifted(0.05, 0.1, 0.1));
    const PlannedMotion a = planner_.plan(at_origin.program());
    const PlannedMotion b = MotionPlanner(placed).plan(elsewhere.program());
    ASSERT_NEAR(a.trajectory.duration(), b.trajectory.duration(), 1e-6);
    const double half = 0.5 * a.trajectory.duration();
    ASSERT_LT((a.trajectory.at(half).q - b.trajectory.at(half).q).cwiseAbs().maxCoeff(), 1e-6);
  }
}

}  // namespace
}  // namespace viapoint
