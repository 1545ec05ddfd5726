#include <gtest/gtest.h>

#include <algorithm>

#include "planning/planner_fixture.hpp"
#include "viapoint/trajectory/tool_certificate.hpp"

namespace viapoint::testing_planner {
namespace {

/// A bead along three sides of a rectangle of 0.2 m by 0.1 m, with a lead in and out.
Script bead(const RobotModel& robot, const JointVector& start, Zone zone) {
  Pose at = robot.forward().pose(start);
  MoveOptions lead, process;
  lead.zone = process.zone = zone;
  lead.speed = 0.3;
  process.process_speed = 0.05;
  Script script(robot, start);
  const auto go = [&](double x, double y, const MoveOptions& options) {
    at.translation() += Eigen::Vector3d(x, y, 0.0);
    script.add(LinMove{PoseTarget{at}}, options);
  };
  go(0.05, 0.0, lead);
  go(0.1, 0.0, process);
  go(0.0, 0.2, process);
  go(-0.1, 0.0, process);
  go(-0.05, 0.0, lead);
  return script;
}

TEST(ProcessSpeed, IsHeldThroughCornersWithAZoneAndAllStretchesThatAreNotAreListed) {
  const RobotPtr arm = robot("ur5e");
  const JointVector start = degrees({10, -80, 110, -120, -90, 10});
  Script script = bead(*arm, start, {ZoneKind::kRadius, 0.02});
  const PlannedMotion motion = MotionPlanner(arm).plan(script.program());
  double process_time = 0.0;
  for (const ToolSpan& span : motion.tool_spans) {
    if (span.limits.hold_speed) process_time += span.to - span.from;
  }
  double lost = 0.0;
  for (const ProcessStretch& stretch : motion.process_stretches) {
    EXPECT_GT(stretch.to, stretch.from);
    EXPECT_GE(stretch.to_length, stretch.from_length);
    EXPECT_LT(stretch.lowest_speed, 0.05);
    EXPECT_FALSE(stretch.limit.empty());
    lost += stretch.to - stretch.from;
  }
  EXPECT_GE(process_time, 0.3 / 0.05);
  EXPECT_LE(lost, 0.05 * process_time);
  const auto listed = [&](double t) {
    return std::any_of(motion.process_stretches.begin(), motion.process_stretches.end(),
                       [&](const ProcessStretch& s) { return s.from <= t && t <= s.to; });
  };
  for (const ToolSpan& span : motion.tool_spans) {
    if (!span.limits.hold_speed) continue;
    for (int k = 0; k <= 2000; ++k) {
      const double t = span.from + (span.to - span.from) * k / 2000.0;
      const JointState state = motion.trajectory.at(t);
      const double speed = (arm->jacobian(state.q).topRows<3>() * state.qd).norm();
      ASSERT_LE(speed, 0.05 * (1.0 + 1e-8)) << t;
      if (!listed(t)) {
        ASSERT_GE(speed, 0.05 * (1.0 - kHeldWithin) * (1.0 - 1e-8)) << t;
      }
    }
  }
}

TEST(ProcessSpeed, IsReportedAsLostWhereTheArmStops) {
  const RobotPtr arm = robot("ur5e");
  Script script = bead(*arm, degrees({10, -80, 110, -120, -90, 10}), {});
  const PlannedMotion motion = MotionPlanner(arm).plan(script.program());
  // Two ends of each of the three moves.
  ASSERT_EQ(motion.process_stretches.size(), 6u);
  size_t warnings = 0;
  for (const Problem& problem : motion.report.problems) {
    warnings += problem.message.find("process speed") != std::string::npos ? 1 : 0;
    EXPECT_TRUE(problem.line);
    EXPECT_FALSE(problem.ways_out.empty());
  }
  EXPECT_EQ(warnings, 6u);
  for (const ProcessStretch& stretch : motion.process_stretches) {
    EXPECT_EQ(stretch.limit, "rest");
    EXPECT_LE(stretch.lowest_speed, 1e-6);
    EXPECT_LE(stretch.to_length - stretch.from_length, 0.02);
  }
}

}  // namespace
}  // namespace viapoint::testing_planner
