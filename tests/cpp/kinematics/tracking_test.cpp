#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "kinematics/arms.hpp"
#include "kinematics/random_lines.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/kinematics/pose_path.hpp"

namespace viapoint {
namespace {

using testing::Line;
using testing::LineArm;

double step_between(const JointVector& a, const JointVector& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

/// Up to which pose some choice of branches goes without a jump, by all solutions of every pose:
/// another way to the answer than the one that is tested.
size_t reach_of_all_branches(const RobotModel& robot, const Line& line) {
  std::vector<JointVector> reached = {robot.inverse().solve_near(line.poses[0], line.start)};
  for (size_t k = 1; k < line.poses.size(); ++k) {
    std::vector<JointVector> next;
    for (const JointVector& from : reached) {
      for (const JointVector& q : robot.inverse().solve_all(line.poses[k], from)) {
        if (step_between(q, from) <= kLargestStep &&
            std::none_of(next.begin(), next.end(),
                         [&](const JointVector& other) { return step_between(q, other) < 1e-7; })) {
          next.push_back(q);
        }
      }
    }
    if (next.empty()) return k;
    reached = std::move(next);
  }
  return line.poses.size();
}

class Tracking : public ::testing::TestWithParam<LineArm> {};

TEST_P(Tracking, FollowsEveryLineThatGeometryLetsItFollow) {
  const RobotPtr robot = arm(GetParam().name);
  const bool open = !robot->inverse().redundancy().empty();
  int followed = 0;
  const int lines = open ? 12 : 60;
  for (int seed = 0; seed < lines; ++seed) {
    SCOPED_TRACE(std::string(GetParam().name) + ", seed " + std::to_string(seed));
    const bool through = seed % 2 == 0;
    const Line line = testing::random_line(*robot, GetParam().singular_joint, through,
                                           static_cast<std::uint64_t>(seed));
    std::vector<JointVector> way;
    try {
      way = follow_poses(*robot, line.poses, line.start);
    } catch (const MotionError& error) {
      ASSERT_EQ(error.code(), ErrorCode::kBranchChange) << error.what();
      if (open) continue;
      const size_t end = reach_of_all_branches(*robot, line);
      ASSERT_LT(end, line.poses.size());
      ASSERT_NEAR(error.problem().share.value(), static_cast<double>(end) / testing::kLineSteps,
                  1e-12);
      continue;
    }
    ++followed;
    ASSERT_EQ(way.size(), line.poses.size());
    for (size_t k = 0; k < way.size(); ++k) {
      ASSERT_LT(pose_distance(robot->forward().pose(way[k]), line.poses[k]), 2e-9);
      ASSERT_TRUE(robot->limits().contains(way[k]));
      ASSERT_LE(step_between(way[k], way[k > 0 ? k - 1 : 0]), kLargestStep);
    }
  }
  EXPECT_GT(followed, lines / 2);
}

INSTANTIATE_TEST_SUITE_P(Arms, Tracking, ::testing::ValuesIn(testing::kLineArms),
                         [](const auto& of) { return std::string(of.param.name); });

// A line of the iiwa on which the nearest solution runs into a limit: another arm angle does not.
TEST(Tracking, SevenJointsTurnAwayFromALimitInTime) {
  const RobotPtr robot = arm("iiwa14");
  int rescued = 0;
  for (std::uint64_t seed = 0; seed < 40 && rescued == 0; ++seed) {
    const Line line = testing::random_line(*robot, 5, true, seed);
    JointVector q = robot->inverse().solve_near(line.poses.front(), line.start);
    bool jumped = false;
    for (const Pose& pose : line.poses) {
      const JointVector next = robot->inverse().solve_near(pose, q);
      jumped = jumped || step_between(next, q) > kLargestStep;
      q = next;
    }
    if (!jumped) continue;
    try {
      (void)follow_poses(*robot, line.poses, line.start);
      ++rescued;
    } catch (const MotionError& error) {
      ASSERT_EQ(error.code(), ErrorCode::kBranchChange);
    }
  }
  EXPECT_EQ(rescued, 1);
}

TEST(Tracking, SaysWhereAndWhichJointWouldJump) {
  const RobotPtr robot = arm("puma560");
  for (std::uint64_t seed = 0;; ++seed) {
    ASSERT_LT(seed, 200U) << "every line could be followed";
    const Line line = testing::random_line(*robot, 4, true, seed);
    try {
      (void)follow_poses(*robot, line.poses, line.start);
    } catch (const MotionError& error) {
      const Problem& problem = error.problem();
      ASSERT_EQ(problem.code, ErrorCode::kBranchChange);
      EXPECT_GT(problem.share.value(), 0.0);
      EXPECT_LE(problem.share.value(), 1.0);
      EXPECT_GE(problem.joint.value(), 0);
      EXPECT_GT(problem.value.value(), kLargestStep);
      EXPECT_EQ(problem.limit.value(), kLargestStep);
      EXPECT_FALSE(problem.ways_out.empty());
      return;
    }
  }
}

TEST(Tracking, NamesThePoseThatIsOutOfReach) {
  const RobotPtr robot = arm("ur5e");
  JointVector q(6);
  q << 0.1, -1.2, 1.4, 0.2, 0.7, -0.3;
  std::vector<Pose> poses(3, robot->forward().pose(q));
  poses[1].translation() += Eigen::Vector3d(3.0, 0.0, 0.0);
  try {
    (void)follow_poses(*robot, poses, q);
    ADD_FAILURE() << "nothing was refused";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnreachable);
    EXPECT_EQ(error.problem().share, 0.5);
    EXPECT_NE(error.problem().message.find("pose 1"), std::string::npos);
  }
  EXPECT_THROW((void)follow_poses(*robot, {}, q), MotionError);
  EXPECT_THROW((void)follow_poses(*robot, poses, q, 0.0), MotionError);
}

}  // namespace
}  // namespace viapoint
