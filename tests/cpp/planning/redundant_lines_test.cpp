// Seven joints on tool curves: what the pose leaves open is chosen with the end in mind.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>

#include "kinematics/random_lines.hpp"
#include "planner_fixture.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/kinematics/pose_path.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/task_curve.hpp"

namespace viapoint {
namespace {

using testing_planner::Script;

class SevenJoints : public ::testing::TestWithParam<testing::LineArm> {
 protected:
  RobotPtr robot_ = testing_planner::robot(GetParam().name);

  void expect_limits_kept(const Trajectory& way) const {
    EXPECT_TRUE(way.certificate().holds());
    for (int k = 0; k <= 300; ++k) {
      ASSERT_TRUE(robot_->limits().contains(way.at(way.duration() * k / 300.0).q, 1e-9));
    }
  }

  /// Joints in the middle of their ranges, and others with the same tool pose.
  [[nodiscard]] std::pair<JointVector, JointVector> two_for_one_pose(std::mt19937& random) const {
    const JointLimits& limits = robot_->limits();
    JointVector q(7);
    for (int i = 0; i < 7; ++i) {
      q[i] = 0.5 * (limits.position_min[i] + limits.position_max[i]) +
             0.25 * (limits.position_max[i] - limits.position_min[i]) *
                 std::uniform_real_distribution<double>(-1.0, 1.0)(random);
    }
    const double open = robot_->inverse().redundancy_of(q);
    for (const double beside : {0.3, -0.3, 0.15, -0.15, 0.05, -0.05}) {
      try {
        return {q, robot_->inverse().solve_all_at(robot_->fk(q), open + beside, q).front()};
      } catch (const MotionError&) {
        continue;
      }
    }
    return {q, q};
  }
};

TEST_P(SevenJoints, PlanWhereTheirPosesCanBeFollowed) {
  int rescued = 0, planned = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const testing::Line line =
        testing::random_line(*robot_, GetParam().singular_joint, seed % 2 == 0, seed);
    const JointVector start = robot_->inverse().solve_near(line.poses.front(), line.start);
    Script script(*robot_, start);
    script.movel(line.poses.back());
    try {
      const Trajectory way = MotionPlanner(robot_).plan(script.program()).trajectory;
      expect_limits_kept(way);
      const Pose reached = robot_->fk(way.at(way.duration()).q);
      ASSERT_LT((reached.translation() - line.poses.back().translation()).norm(), 1e-6);
      ++planned;
      // What the least motion cannot do.
      InsertionOptions greedy;
      const LineCurve curve(robot_->fk(start), line.poses.back());
      try {
        (void)insert_curve(robot_->forward(), robot_->limits(), curve, start, greedy);
      } catch (const MotionError&) {
        ++rescued;
      }
    } catch (const MotionError& refused) {
      ASSERT_TRUE(refused.problem().share.has_value()) << refused.what();
      EXPECT_THROW((void)follow_poses(*robot_, line.poses, line.start), MotionError)
          << refused.what();
    }
  }
  EXPECT_GT(planned, 14);
  EXPECT_GT(rescued, 0);
}

TEST_P(SevenJoints, ArriveAtTheJointsThatAreGiven) {
  int planned = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto [start, same] = two_for_one_pose(random);
    JointVector goal = same;
    for (double& value : goal) value += std::uniform_real_distribution<double>(-0.15, 0.15)(random);
    if (!robot_->limits().contains(goal)) continue;
    Script script(*robot_, start);
    MoveOptions options;
    if (seed % 2 == 0) {
      script.add(LinMove{JointTarget{goal}}, options);
    } else {
      Pose via = robot_->fk(0.5 * (start + goal));
      via.translation() += Eigen::Vector3d(0.03, 0.0, 0.02);
      script.add(CircMove{PoseTarget{via}, JointTarget{goal}, Orientation::kLeast}, options);
    }
    try {
      const Trajectory way = MotionPlanner(robot_).plan(script.program()).trajectory;
      expect_limits_kept(way);
      ASSERT_LT((way.at(way.duration()).q - goal).cwiseAbs().maxCoeff(), 1e-3);
      ++planned;
    } catch (const MotionError& error) {
      ASSERT_TRUE(error.problem().share.has_value()) << error.what();
    }
  }
  EXPECT_GT(planned, 6);
}

TEST_P(SevenJoints, GoTheSameWayEveryTime) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto [start, goal] = two_for_one_pose(random);
    Script script(*robot_, start);
    Pose aside = robot_->fk(goal);
    aside.translation() += Eigen::Vector3d(0.0, 0.05, -0.05);
    script.movel(aside);
    script.add(LinMove{JointTarget{goal}});
    const MotionPlanner planner(robot_);
    if (!planner.check(script.program()).ok()) continue;
    const Trajectory once = planner.plan(script.program()).trajectory;
    const Trajectory again = planner.plan(script.program()).trajectory;
    ASSERT_EQ(once.duration(), again.duration());
    for (int k = 0; k <= 50; ++k) {
      ASSERT_EQ(once.at(once.duration() * k / 50.0).q, again.at(once.duration() * k / 50.0).q);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, SevenJoints,
                         ::testing::Values(testing::kLineArms[2], testing::kLineArms[3]),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(SevenJointWrist, CannotBeInterpolatedWhereTheFirstThreeJointsTurnAboutOnePoint) {
  for (const char* name : {"panda", "iiwa14"}) {
    SCOPED_TRACE(name);
    const RobotPtr arm = testing_planner::robot(name);
    const JointVector home = testing_planner::degrees({0, 20, 0, -100, 0, 80, 0});
    Pose goal = arm->forward().pose(home);
    goal.translation().x() += 0.05;
    Script script(*arm, home);
    script.movel(goal, {}, Orientation::kWrist);
    const Report report = MotionPlanner(arm).check(script.program());
    ASSERT_EQ(report.problems.size(), 1U) << report.describe();
    const Problem& problem = report.problems.front();
    EXPECT_EQ(problem.code, ErrorCode::kUncontrolled) << problem.describe();
    EXPECT_NE(problem.message.find("control only 2 of its 3 coordinates"), std::string::npos)
        << problem.message;
    EXPECT_EQ(problem.value, 2.0);
    EXPECT_TRUE(
        std::any_of(problem.ways_out.begin(), problem.ways_out.end(),
                    [](const std::string& way) { return way.find("least") != std::string::npos; }));
    // That way out works.
    Script least(*arm, home);
    least.movel(goal);
    EXPECT_TRUE(MotionPlanner(arm).check(least.program()).ok());
  }
}

}  // namespace
}  // namespace viapoint
