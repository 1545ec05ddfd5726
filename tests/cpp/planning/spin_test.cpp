// Moves that hold the tool's axis and leave its spin free.
#include <gtest/gtest.h>

#include <optional>

#include "planning/planner_fixture.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;

/// The target, spun about the tool's axis.
Pose spun(const Pose& pose, double angle) {
  return pose * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
}

Pose shifted(const Pose& pose, const Eigen::Vector3d& by) {
  Pose moved = pose;
  moved.translation() += by;
  return moved;
}

void expect_on_axis(const RobotModel& robot, const JointVector& q, const Pose& wanted) {
  const Pose pose = robot.forward().pose(q);
  EXPECT_LT((pose.translation() - wanted.translation()).norm(), 1e-6);
  EXPECT_LT((pose.linear().col(2) - wanted.linear().col(2)).norm(), 1e-6);
}

class Spin : public ::testing::Test {
 protected:
  RobotPtr arm_ = robot("puma560");
  JointVector home_ = degrees({0, 25, 0, 15, 50, 10});
  Pose here_ = arm_->forward().pose(home_);

  Trajectory plan(const MotionProgram& program) const {
    return MotionPlanner(arm_).plan(program).trajectory;
  }
};

TEST_F(Spin, OfTheTargetDoesNotMatter) {
  const Pose target = shifted(here_, {0.02, 0.08, -0.03});
  std::optional<double> duration;
  for (const double angle : {0.0, 1.0, kPi, -2.5}) {
    Script script(*arm_, home_);
    script.movel(spun(target, angle), {}, Orientation::kSpin);
    const Trajectory motion = plan(script.program());
    ASSERT_TRUE(motion.certificate().holds());
    const JointVector end = motion.at(motion.duration()).q;
    expect_on_axis(*arm_, end, target);
    // The last axis is the tool's: turning it does nothing, so it rests.
    EXPECT_LT(std::abs(end[5] - home_[5]), 1e-6);
    if (!duration) duration = motion.duration();
    EXPECT_NEAR(motion.duration(), *duration, 1e-6);
  }
}

TEST_F(Spin, TurnsTheAxisTheLeastWay) {
  const Pose target = spun(
      shifted(here_, {0.0, 0.06, 0.0}) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()), 2.0);
  Script script(*arm_, home_);
  script.movel(target, {}, Orientation::kSpin);
  const Trajectory motion = plan(script.program());
  const Eigen::Vector3d normal = here_.linear().col(2).cross(target.linear().col(2)).normalized();
  for (int i = 0; i <= 200; ++i) {
    const Pose pose = arm_->forward().pose(motion.at(motion.duration() * i / 200).q);
    ASSERT_LT(std::abs(pose.linear().col(2).dot(normal)), 2.0 * kDegree / 100.0);
  }
  expect_on_axis(*arm_, motion.at(motion.duration()).q, target);
}

TEST_F(Spin, BlendsOnAcrossArcsTurnsAndSplines) {
  const Zone zone = {ZoneKind::kRadius, 0.005};
  Script script(*arm_, home_);
  MoveOptions options;
  options.zone = zone;
  script.movel(shifted(here_, {0.0, 0.05, 0.0}), zone, Orientation::kSpin);
  script.add(CircMove{PositionTarget{here_.translation() + Eigen::Vector3d(0.02, 0.08, 0.0)},
                      PoseTarget{spun(shifted(here_, {0.05, 0.09, 0.0}), 1.0)}, Orientation::kSpin},
             options);
  TurnMove turn;
  turn.center = here_.translation() + Eigen::Vector3d(0.05, 0.06, 0.0);
  turn.axis = Eigen::Vector3d::UnitZ();
  turn.angle = 4.0;
  turn.orientation = Orientation::kSpin;
  script.add(turn, options);
  SplineMove spline;
  spline.orientation = Orientation::kSpin;
  spline.points = {PoseTarget{spun(shifted(here_, {0.03, 0.03, 0.01}), -2.0)},
                   PoseTarget{shifted(here_, {0.0, 0.0, 0.02})}};
  script.add(spline, options);
  const PlannedMotion planned = MotionPlanner(arm_).plan(script.program());
  ASSERT_TRUE(planned.trajectory.certificate().holds());
  EXPECT_EQ(planned.corners.size(), 3U);
  expect_on_axis(*arm_, planned.trajectory.at(planned.trajectory.duration()).q,
                 shifted(here_, {0.0, 0.0, 0.02}));
}

TEST_F(Spin, RefusesTheOppositeAxis) {
  Script script(*arm_, home_);
  script.movel(shifted(here_, {0.0, 0.05, 0.0}) * Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()),
               {}, Orientation::kSpin);
  const Report report = MotionPlanner(arm_).check(script.program());
  ASSERT_EQ(report.problems.size(), 1U);
  EXPECT_EQ(report.problems.front().code, ErrorCode::kHalfTurn);
}

}  // namespace
}  // namespace viapoint
