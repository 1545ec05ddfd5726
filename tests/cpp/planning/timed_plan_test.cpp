#include "viapoint/planning/timed_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "golden.hpp"
#include "planning/planner_fixture.hpp"
#include "problem_count.hpp"
#include "viapoint/path/drive_transform.hpp"

namespace viapoint {
namespace {

using testing_planner::degrees;
using testing_planner::puma_a;
using testing_planner::puma_b;
using testing_planner::puma_c;
using testing_planner::robot;
using testing_planner::Script;

/// The reference job of the textbook, §3.
TimedMove reference_move(const RobotModel& arm, TimedSpace space) {
  TimedMove move;
  move.t_acc = 0.2;
  move.space = space;
  for (const JointVector& q : {puma_a(), puma_b(), puma_c()}) {
    const double seconds = move.points.empty() ? 0.0 : 0.5;
    if (space == TimedSpace::kJoint) {
      move.points.push_back({JointTarget{q}, seconds});
    } else {
      move.points.push_back({PoseTarget{arm.fk(q)}, seconds});
    }
  }
  return move;
}

PlannedMotion planned(const RobotModel& arm, const TimedMove& move, const JointVector& start) {
  Script script(arm, start);
  script.add(move);
  return plan_timed(arm, script.program(), move, 0);
}

const Problem* find(const Report& report, ErrorCode code, std::optional<int> joint = {}) {
  for (const Problem& problem : report.problems) {
    if (problem.code == code && (!joint || problem.joint == joint)) return &problem;
  }
  return nullptr;
}

TEST(TimedPlan, GoldenTextbookSection3JointMove) {
  const RobotPtr arm = robot("puma560");
  const PlannedMotion motion = planned(*arm, reference_move(*arm, TimedSpace::kJoint), puma_a());
  ASSERT_EQ(motion.trajectory.pieces().size(), 3u);
  EXPECT_EQ(motion.trajectory.duration(), 1.0);
  const nlohmann::json rows = golden("puma560").at("joint_move_deg");
  ASSERT_EQ(rows.size(), 9u);
  for (const auto& row : rows) {
    const JointState state = motion.trajectory.at(row.at("t").get<double>() + 0.5);
    for (int j = 0; j < 6; ++j) {
      const auto at = static_cast<size_t>(j);
      EXPECT_NEAR(state.q[j] / kDegree, row.at("q")[at].get<double>(), 1e-10) << row.at("t");
      EXPECT_NEAR(state.qd[j] / kDegree, row.at("qd")[at].get<double>(), 1e-9) << row.at("t");
      EXPECT_NEAR(state.qdd[j] / kDegree, row.at("qdd")[at].get<double>(), 1e-8) << row.at("t");
    }
  }
}

TEST(TimedPlan, GoldenTextbookSection3CartesianMove) {
  const RobotPtr arm = robot("puma560");
  const TimedMove move = reference_move(*arm, TimedSpace::kCartesian);
  const PlannedMotion motion = planned(*arm, move, puma_a());
  ASSERT_FALSE(motion.trajectory.pieces().empty()) << motion.report.describe();
  EXPECT_NEAR(motion.trajectory.duration(), 1.0, 1e-12);
  const nlohmann::json rows = golden("puma560").at("cartesian_move");
  ASSERT_EQ(rows.size(), 9u);
  for (const auto& row : rows) {
    const Pose wanted = golden_pose(row.at("pose"));
    const Pose is = arm->fk(motion.trajectory.at(row.at("t").get<double>() + 0.5).q);
    EXPECT_LT((wanted.translation() - is.translation()).norm(), 1e-6) << row.at("t");
    EXPECT_LT(rotation_distance(wanted.linear(), is.linear()), 1e-6) << row.at("t");
  }
}

TEST(TimedPlan, FollowsTheDriveTransformAtEverySample) {
  const RobotPtr arm = robot("puma560");
  const PlannedMotion motion =
      planned(*arm, reference_move(*arm, TimedSpace::kCartesian), puma_a());
  const DriveMotion tool(std::array{arm->fk(puma_a()), arm->fk(puma_b()), arm->fk(puma_c())},
                         std::array{0.5, 0.5}, 0.2);
  double position = 0.0, angle = 0.0;
  for (int i = 0; i <= 5000; ++i) {
    const double t = i / 5000.0;
    const Pose wanted = tool.at(t).pose, is = arm->fk(motion.trajectory.at(t).q);
    position = std::max(position, (wanted.translation() - is.translation()).norm());
    angle = std::max(angle, rotation_distance(wanted.linear(), is.linear()));
  }
  EXPECT_LE(position, 1.1 * kTimedPoseError);
  EXPECT_LE(angle, 1.1 * kTimedPoseError);
  EXPECT_LE(motion.trajectory.certificate().position_jump, 1e-12);
  RecordProperty("pieces", static_cast<int>(motion.trajectory.pieces().size()));
}

TEST(TimedPlan, ToolMovesAtTheRatesOfTheDriveTransform) {
  const RobotPtr arm = robot("puma560");
  const PlannedMotion motion =
      planned(*arm, reference_move(*arm, TimedSpace::kCartesian), puma_a());
  const DriveMotion tool(std::array{arm->fk(puma_a()), arm->fk(puma_b()), arm->fk(puma_c())},
                         std::array{0.5, 0.5}, 0.2);
  double t = 0.0;
  for (const TrajectoryPiece& piece : motion.trajectory.pieces()) {
    const JointState knot = piece.at(0.0);
    const ToolState wanted = tool.at(t + 1e-12);
    const Twist rate = arm->jacobian(knot.q) * knot.qd;
    EXPECT_LT((rate.head<3>() - wanted.velocity).norm(), 1e-8) << t;
    EXPECT_LT((rate.tail<3>() - wanted.angular_velocity).norm(), 1e-8) << t;
    t += piece.duration;
  }
}

TEST(TimedPlan, ReportsWhatTheJointMoveBreaks) {
  const RobotPtr arm = robot("puma560");
  const PlannedMotion motion = planned(*arm, reference_move(*arm, TimedSpace::kJoint), puma_a());
  EXPECT_FALSE(motion.report.ok());
  const Problem* rest = find(motion.report, ErrorCode::kNotAtRest);
  ASSERT_NE(rest, nullptr);
  EXPECT_EQ(rest->move, 0);
  EXPECT_EQ(rest->file, "cell.py");
  EXPECT_EQ(rest->line, 1);
  const Problem* fast = find(motion.report, ErrorCode::kVelocityLimit, 5);
  ASSERT_NE(fast, nullptr) << motion.report.describe();
  EXPECT_NEAR(fast->value.value() / kDegree, 416.9946, 1e-3);
  EXPECT_NEAR(fast->limit.value(), arm->limits().velocity[5], 1e-12);
  EXPECT_EQ(find(motion.report, ErrorCode::kDiscontinuous), nullptr) << motion.report.describe();
  EXPECT_EQ(find(motion.report, ErrorCode::kJointLimit), nullptr) << motion.report.describe();
}

TEST(TimedPlan, ReportsWhereTheDriveTransformLeavesTheLimits) {
  const RobotPtr arm = robot("puma560");
  const PlannedMotion motion =
      planned(*arm, reference_move(*arm, TimedSpace::kCartesian), puma_a());
  ASSERT_FALSE(motion.trajectory.pieces().empty()) << motion.report.describe();
  const Problem* left = find(motion.report, ErrorCode::kJointLimit);
  ASSERT_NE(left, nullptr) << motion.report.describe();
  const int joint = left->joint.value();
  // The textbook's clock begins half a second earlier: +0.374 s there.
  double first = 2.0;
  for (double t = 0.0; t <= 1.0 && first > 1.0; t += 1e-4) {
    if (!arm->limits().contains(motion.trajectory.at(t).q)) first = t;
  }
  EXPECT_NEAR(first, 0.874, 1e-3);
  EXPECT_EQ(joint, 3);
}

TEST(TimedPlan, ReportsTheJumpsOfTheAngularVelocity) {
  const RobotPtr arm = robot("puma560");
  const PlannedMotion motion =
      planned(*arm, reference_move(*arm, TimedSpace::kCartesian), puma_a());
  const Problem* jump = find(motion.report, ErrorCode::kDiscontinuous);
  ASSERT_NE(jump, nullptr);
  EXPECT_NEAR(jump->time.value(), 0.3, 1e-12);
  EXPECT_NEAR(jump->value.value(), 2.21, 0.005);
  EXPECT_GT(motion.trajectory.certificate().velocity_jump, 0.1);
}

TEST(TimedPlan, ReportsAStartElsewhere) {
  const RobotPtr arm = robot("puma560");
  const PlannedMotion motion = planned(*arm, reference_move(*arm, TimedSpace::kJoint), puma_b());
  const Problem* elsewhere = find(motion.report, ErrorCode::kNotAtStart);
  ASSERT_NE(elsewhere, nullptr);
  EXPECT_FALSE(motion.trajectory.pieces().empty());
}

TEST(TimedPlan, TakesPosesInJointSpaceAndJointsInCartesianSpace) {
  const RobotPtr arm = robot("puma560");
  TimedMove mixed = reference_move(*arm, TimedSpace::kJoint);
  mixed.points[1].target = PoseTarget{arm->fk(puma_b())};
  const PlannedMotion joint = planned(*arm, mixed, puma_a());
  ASSERT_EQ(joint.trajectory.pieces().size(), 3u) << joint.report.describe();
  TimedMove tool = reference_move(*arm, TimedSpace::kCartesian);
  tool.points[0].target = JointTarget{puma_a()};
  const PlannedMotion cartesian = planned(*arm, tool, puma_a());
  ASSERT_FALSE(cartesian.trajectory.pieces().empty()) << cartesian.report.describe();
  EXPECT_LT((cartesian.trajectory.at(0.0).q - puma_a()).norm(), 1e-12);
}

TEST(TimedPlan, MovesATwoJointArmByPositionsAlone) {
  // The textbook's two-link arm, from near (3, 0) to (2, 2) in 2 s (§5), elbow bent from the start.
  const RobotPtr arm = robot("two_link");
  const JointVector start = degrees({40.0, -70.0});
  TimedMove move;
  move.space = TimedSpace::kCartesian;
  move.points.push_back({JointTarget{start}, 0.0});
  move.points[0].target = PositionTarget{arm->fk(start).translation()};
  const double z = arm->fk(start).translation().z();
  move.points.push_back({PositionTarget{{2.0, 2.0, z}}, 2.0});
  const PlannedMotion motion = planned(*arm, move, start);
  ASSERT_FALSE(motion.trajectory.pieces().empty()) << motion.report.describe();
  const Pose end = arm->fk(motion.trajectory.at(2.0).q);
  EXPECT_LT((end.translation() - Eigen::Vector3d(2.0, 2.0, z)).norm(), 1e-9);
  const Pose middle = arm->fk(motion.trajectory.at(1.0).q);
  const Eigen::Vector3d half = 0.5 * (arm->fk(start).translation() + Eigen::Vector3d(2.0, 2.0, z));
  EXPECT_LT((middle.translation() - half).norm(), 1.1e-6);
}

TEST(TimedPlan, SaysWhichCoordinatesATwoJointArmCannotHold) {
  const RobotPtr arm = robot("two_link");
  const JointVector start = degrees({40.0, -70.0}), goal = degrees({80.0, -40.0});
  TimedMove move;
  move.space = TimedSpace::kCartesian;
  move.points = {{JointTarget{start}, 0.0}, {PoseTarget{arm->fk(goal)}, 2.0}};
  const PlannedMotion motion = planned(*arm, move, start);
  EXPECT_TRUE(motion.trajectory.pieces().empty());
  EXPECT_NE(find(motion.report, ErrorCode::kUncontrolled), nullptr) << motion.report.describe();
}

TEST(TimedPlan, ReportsPointsAndTimesThatCannotBeAndPlansNothing) {
  const RobotPtr arm = robot("puma560");
  const TimedMove good = reference_move(*arm, TimedSpace::kCartesian);
  const auto code_of = [&](const TimedMove& move) {
    const PlannedMotion motion = planned(*arm, move, puma_a());
    EXPECT_TRUE(motion.trajectory.pieces().empty());
    EXPECT_FALSE(motion.report.ok());
    return motion.report.problems.empty() ? ErrorCode::kInternal
                                          : motion.report.problems.back().code;
  };
  TimedMove far = good;
  Pose pose = arm->fk(puma_c());
  pose.translation() *= 3.0;
  far.points[2].target = PoseTarget{pose};
  EXPECT_EQ(code_of(far), ErrorCode::kUnreachable);
  TimedMove none = good;
  none.points.clear();
  EXPECT_EQ(code_of(none), ErrorCode::kBadArgument);
  TimedMove hasty = good;
  hasty.t_acc = 0.6;
  EXPECT_EQ(code_of(hasty), ErrorCode::kBadArgument);
  TimedMove early = good;
  early.points[0].seconds = 0.1;
  EXPECT_EQ(code_of(early), ErrorCode::kBadArgument);
  TimedMove frozen = good;
  frozen.points[1].seconds = 0.0;
  EXPECT_EQ(code_of(frozen), ErrorCode::kBadArgument);
  TimedMove wrong = good;
  wrong.space = TimedSpace::kJoint;
  wrong.points[1].target = JointTarget{degrees({1.0, 2.0})};
  EXPECT_EQ(code_of(wrong), ErrorCode::kBadArgument);
}

TEST(TimedPlan, MovesARobotWithoutKinematicsInJointsOnly) {
  JointLimits limits = robot("puma560")->limits();
  const RobotPtr arm = RobotModel::joint_robot(limits);
  TimedMove move = reference_move(*robot("puma560"), TimedSpace::kJoint);
  EXPECT_EQ(planned(*arm, move, puma_a()).trajectory.pieces().size(), 3u);
  move.space = TimedSpace::kCartesian;
  const PlannedMotion motion = planned(*arm, move, puma_a());
  EXPECT_NE(find(motion.report, ErrorCode::kUncontrolled), nullptr);
}

TEST(TimedPlan, FollowsRandomMotionsOfTheToolOrSaysWhyNot) {
  const RobotPtr arm = robot("puma560");
  int planned_motions = 0;
  for (int seed = 0; seed < problems(300); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> nearby(-0.6, 0.6);
    const auto joints = [&] {
      JointVector q = degrees({0.0, 45.0, 30.0, 20.0, 60.0, 10.0});
      for (int i = 0; i < 6; ++i) q[i] += nearby(random);
      return q;
    };
    const JointVector start = joints();
    TimedMove move;
    move.space = TimedSpace::kCartesian;
    move.points = {{JointTarget{start}, 0.0},
                   {PoseTarget{arm->fk(joints())}, 1.0},
                   {PoseTarget{arm->fk(joints())}, 1.5}};
    std::vector<Pose> poses{arm->fk(start)};
    for (size_t i = 1; i < 3; ++i) {
      poses.push_back(std::get<PoseTarget>(move.points[i].target).pose_base_tool);
    }
    const DriveMotion tool(poses, std::array{1.0, 1.5}, move.t_acc);
    const PlannedMotion motion = planned(*arm, move, start);
    if (motion.trajectory.pieces().empty()) {
      ASSERT_FALSE(motion.report.ok());
      const ErrorCode code = motion.report.problems.back().code;
      EXPECT_TRUE(code == ErrorCode::kSingular || code == ErrorCode::kUnreachable)
          << motion.report.describe();
      continue;
    }
    ++planned_motions;
    for (int i = 0; i <= 100; ++i) {
      const double t = 2.5 * i / 100.0;
      const Pose wanted = tool.at(t).pose, is = arm->fk(motion.trajectory.at(t).q);
      EXPECT_LT((wanted.translation() - is.translation()).norm(), 2.0 * kTimedPoseError) << t;
      EXPECT_LT(rotation_distance(wanted.linear(), is.linear()), 2.0 * kTimedPoseError) << t;
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(planned_motions, problems(250));
}

}  // namespace
}  // namespace viapoint
