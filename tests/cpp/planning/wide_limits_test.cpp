/// @file
/// Position limits of many turns: every branch then stands on thousands of turns of its joints, and
/// neither plan nor check may try them all.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "problem_count.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/planning/motion_planner.hpp"

namespace viapoint {
namespace {

RobotPtr puma560_of_many_turns() {
  const RobotPtr robot = RobotModel::make(load_description("puma560"));
  JointLimits limits = robot->limits();
  limits.position_min.setConstant(-20.0);
  limits.position_max.setConstant(20.0);
  return robot->with_limits(limits);
}

/// A line whose middle has joint 5 near zero; empty where its start is out of reach.
MotionProgram line_by_singular_wrist(const RobotModel& robot, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> normal;
  JointVector q(6);
  for (double& value : q) value = 2.5 * unit(random);
  q[4] = std::pow(10.0, -3.0 + 2.5 * unit(random));
  Eigen::Vector3d travel(normal(random), normal(random), normal(random));
  travel *= std::pow(10.0, -1.5 + unit(random)) / travel.norm();
  Pose from = robot.fk(q);
  Pose to = from;
  from.translation() -= travel;
  to.translation() += travel;
  MotionProgram program;
  try {
    program.start = robot.inverse().solve_near(from, q);
  } catch (const MotionError&) {
    return program;
  }
  program.steps.emplace_back().what = LinMove{PoseTarget{to}};
  return program;
}

// Some of these lines cannot be followed, and the way out with the wrist interpolated is then tried
// for every end: over all turns of all joints that were 32768 curves, half a minute a line.
TEST(WideLimits, LinesByTheSingularWristArePlannedOrRefusedByName) {
  constexpr unsigned kLines = problems(2000U);
  const RobotPtr robot = puma560_of_many_turns();
  const MotionPlanner planner(robot);
  int planned = 0;
  int refused = 0;
  for (unsigned seed = 0; seed < kLines; ++seed) {
    SCOPED_TRACE(seed);
    const MotionProgram program = line_by_singular_wrist(*robot, seed);
    if (program.steps.empty()) continue;
    const Report report = planner.check(program);
    if (report.ok()) {
      ++planned;
      continue;
    }
    ++refused;
    const ErrorCode code = report.problems.front().code;
    ASSERT_TRUE(code == ErrorCode::kUnreachable || code == ErrorCode::kSingular ||
                code == ErrorCode::kBranchChange || code == ErrorCode::kJointLimit)
        << report.describe();
  }
  EXPECT_GT(planned, static_cast<int>(kLines / 4));
  EXPECT_GT(refused, static_cast<int>(kLines / 100));
}

}  // namespace
}  // namespace viapoint
