// Random straight lines as moves, half of them through a singular pose: the planner goes where a
// follower of poses can go, and says where it cannot.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "kinematics/random_lines.hpp"
#include "planner_fixture.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/kinematics/pose_path.hpp"

namespace viapoint {
namespace {

using testing_planner::Script;

bool can_be_followed(const RobotModel& robot, const testing::Line& line) {
  try {
    (void)follow_poses(robot, line.poses, line.start);
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBranchChange) << error.what();
    return false;
  }
  return true;
}

TEST(LineTracking, LinesArePlannedExactlyWhereTheirPosesCanBeFollowed) {
  int planned = 0;
  int refused = 0;
  for (const char* name : {"puma560", "ur5e"}) {
    const RobotPtr robot = testing_planner::robot(name);
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const bool through = seed % 2 == 0;
      const testing::Line line = testing::random_line(*robot, 4, through, seed);
      const JointVector start = robot->inverse().solve_near(line.poses.front(), line.start);
      const bool followed = can_be_followed(*robot, line);
      Script script(*robot, start);
      script.movel(line.poses.back());
      try {
        const Trajectory way = MotionPlanner(robot).plan(script.program()).trajectory;
        // Where joints turn quickly past a singular pose, the poses have to stand closer.
        const int finer = 16 * testing::kLineSteps;
        ASSERT_TRUE(followed ||
                    can_be_followed(*robot, testing::random_line(*robot, 4, through, seed, finer)));
        ++planned;
        const Pose reached = robot->fk(way.at(way.duration()).q);
        ASSERT_LT((reached.translation() - line.poses.back().translation()).norm(), 1e-6);
      } catch (const MotionError& error) {
        ASSERT_FALSE(followed) << error.what();
        ASSERT_TRUE(error.problem().share.has_value()) << error.what();
        ASSERT_GE(*error.problem().share, 0.0);
        ASSERT_LE(*error.problem().share, 1.0);
        ASSERT_FALSE(error.problem().ways_out.empty());
        ++refused;
      }
    }
  }
  EXPECT_GT(planned, 20);
  EXPECT_GT(refused, 5);
}

}  // namespace
}  // namespace viapoint
