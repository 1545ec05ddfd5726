/// @file
/// Curves of the tool on real robots, in few words.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>

#include "planning/planner_fixture.hpp"

namespace viapoint::testing_planner {

inline JointVector home() { return degrees({0, 25, 0, 15, 50, 10}); }

/// The pose at `q`, moved in the base frame.
inline Pose moved(const RobotModel& arm, const JointVector& q, const Eigen::Vector3d& by) {
  Pose pose = arm.forward().pose(q);
  pose.translation() += by;
  return pose;
}

inline Pose tool_at(const RobotModel& arm, const PlannedMotion& motion, double share) {
  return arm.forward().pose(motion.trajectory.at(share * motion.trajectory.duration()).q);
}

inline Problem only_problem(const RobotPtr& arm, const MotionProgram& program) {
  const Report report = MotionPlanner(arm).check(program);
  EXPECT_EQ(report.problems.size(), 1u) << report.describe();
  return report.problems.empty() ? Problem{} : report.problems.front();
}

inline SplineMove through(std::initializer_list<Pose> poses) {
  SplineMove move;
  for (const Pose& pose : poses) move.points.emplace_back(PoseTarget{pose});
  return move;
}

}  // namespace viapoint::testing_planner
