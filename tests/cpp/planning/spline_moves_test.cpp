// Splines as moves of a program.
#include <gtest/gtest.h>

#include <cmath>

#include "planning/curve_fixture.hpp"
#include "planning/planner_fixture.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;
using Eigen::Vector3d;

TEST(SplineMove, PassesEveryPose) {
  const RobotPtr puma = robot("puma560");
  const Pose first = moved(*puma, home(), {0.05, 0.05, 0.02});
  Pose second = moved(*puma, home(), {0.0, 0.12, 0.0});
  second.linear() = rotation_exp({0.1, 0.3, -0.2}) * second.linear();
  const Pose third = moved(*puma, home(), {-0.05, 0.15, 0.03});
  for (const SplineKind kind : {SplineKind::kCubic, SplineKind::kQuintic}) {
    SplineMove move = through({first, second, third});
    move.kind = kind;
    Script script(*puma, home());
    script.add(move);
    const PlannedMotion motion = MotionPlanner(puma).plan(script.program());
    EXPECT_TRUE(motion.trajectory.certificate().holds());
    for (const Pose& pose : {first, second, third}) {
      double off = 1.0;
      double turned = 1.0;
      for (int i = 0; i <= 8000; ++i) {
        const Pose here = tool_at(*puma, motion, i / 8000.0);
        const double distance = (here.translation() - pose.translation()).norm();
        if (distance < off) {
          off = distance;
          turned = rotation_distance(here.linear(), pose.linear());
        }
      }
      EXPECT_LT(off, 1e-4);
      EXPECT_LT(turned, 2e-3);
    }
  }
}

TEST(SplineMove, ByControlPointsStaysInTheirHull) {
  const RobotPtr puma = robot("puma560");
  for (const SplineKind kind : {SplineKind::kBezier, SplineKind::kBSpline}) {
    SplineMove move =
        through({moved(*puma, home(), {0.05, 0.0, 0.0}), moved(*puma, home(), {0.05, 0.08, 0.0}),
                 moved(*puma, home(), {0.0, 0.08, 0.0}), moved(*puma, home(), {-0.05, 0.08, 0.0})});
    move.kind = kind;
    Script script(*puma, home());
    script.add(move);
    const PlannedMotion motion = MotionPlanner(puma).plan(script.program());
    const Vector3d at = puma->forward().pose(home()).translation();
    for (int i = 0; i <= 500; ++i) {
      const Vector3d off = tool_at(*puma, motion, i / 500.0).translation() - at;
      EXPECT_LE(std::max({off.x() - 0.05, -0.05 - off.x(), off.y() - 0.08, -off.y()}), 5e-5);
      EXPECT_LE(std::abs(off.z()), 5e-5);
    }
    EXPECT_LT((tool_at(*puma, motion, 1.0).translation() - at - Vector3d(-0.05, 0.08, 0)).norm(),
              1e-7);
  }
}

TEST(SplineMove, LeadsTheToolAlongItsTangent) {
  const RobotPtr puma = robot("puma560");
  SplineMove move =
      through({moved(*puma, home(), {0.05, 0.03, 0.0}), moved(*puma, home(), {0.10, 0.02, 0.0}),
               moved(*puma, home(), {0.15, 0.04, 0.0})});
  move.orientation = Orientation::kTangent;
  Script script(*puma, home());
  script.add(move);
  const PlannedMotion motion = MotionPlanner(puma).plan(script.program());
  const Trajectory& trajectory = motion.trajectory;
  Vector3d in_tool = Vector3d::Zero();
  for (int i = 1; i < 500; ++i) {
    const JointState state = trajectory.at(trajectory.duration() * i / 500.0);
    const ChainFrames frames = puma->forward().frames(state.q);
    const Vector3d velocity = puma->forward().jacobian(frames).topRows<3>() * state.qd;
    const Vector3d seen = frames.pose_base_tool.linear().transpose() * velocity.normalized();
    if (i == 1) in_tool = seen;
    ASSERT_LT((seen - in_tool).norm(), 5e-3) << i;
  }
}

TEST(SplineMove, OfTheJointsPassesThemAndKeepsTheirLimits) {
  const RobotPtr puma = robot("puma560");
  SplineMove move;
  move.space = SplineSpace::kJoint;
  for (const JointVector& q : {degrees({10, 30, 10, 0, 50, 30}), degrees({40, 10, 20, -20, 60, 0}),
                               degrees({50, 0, 0, 0, 40, -20})}) {
    move.points.emplace_back(JointTarget{q});
  }
  Script script(*puma, home());
  script.add(move);
  const PlannedMotion motion = MotionPlanner(puma).plan(script.program());
  EXPECT_TRUE(motion.trajectory.certificate().holds());
  for (const Target& target : move.points) {
    double off = 10.0;
    for (int i = 0; i <= 5000; ++i) {
      const JointVector q = motion.trajectory.at(motion.trajectory.duration() * i / 5000.0).q;
      off = std::min(off, (q - std::get<JointTarget>(target).q).norm());
    }
    EXPECT_LT(off, 1e-3);
  }
  // An overshoot beyond a limit that every point keeps is found, with its place.
  const double limit = puma->limits().position_max[0];
  JointVector at_limit = home();
  at_limit[0] = limit;
  JointVector beside = home();
  beside[0] = limit - 0.05;
  beside[1] += 0.5;
  move.points = {JointTarget{at_limit}, JointTarget{beside}};
  Script over(*puma, home());
  over.add(move);
  const Problem problem = only_problem(puma, over.program());
  EXPECT_EQ(problem.code, ErrorCode::kJointLimit);
  EXPECT_EQ(problem.joint, 0);
  EXPECT_GT(*problem.value, limit);
  EXPECT_GT(*problem.share, 0.0);
}

TEST(SplineMove, RefusesCurvesThatAreNone) {
  const RobotPtr puma = robot("puma560");
  const auto code = [&](const SplineMove& move) {
    Script script(*puma, home());
    script.add(move);
    const Problem problem = only_problem(puma, script.program());
    EXPECT_FALSE(problem.message.empty());
    return problem.code;
  };
  EXPECT_EQ(code({}), ErrorCode::kBadArgument);
  const Pose a = moved(*puma, home(), {0.05, 0.0, 0.0});
  const Pose b = moved(*puma, home(), {0.05, 0.05, 0.0});
  EXPECT_EQ(code(through({a, a, b})), ErrorCode::kDegenerateCurve);
  SplineMove cusp =
      through({moved(*puma, home(), {0.05, 0.05, 0.0}), moved(*puma, home(), {0.0, 0.05, 0.0}), a});
  cusp.kind = SplineKind::kBezier;
  EXPECT_EQ(code(cusp), ErrorCode::kDegenerateCurve);
  SplineMove mixed = through({a, b});
  mixed.points.emplace_back(PositionTarget{b.translation() + Vector3d(0, 0.02, 0)});
  EXPECT_EQ(code(mixed), ErrorCode::kBadArgument);
  SplineMove elsewhere = through({a, b});
  elsewhere.start = PoseTarget{moved(*puma, home(), {0.0, 0.0, 0.01})};
  EXPECT_EQ(code(elsewhere), ErrorCode::kDiscontinuous);
  SplineMove falling = through({a, b});
  falling.at = {0.0, 2.0, 1.0};
  EXPECT_EQ(code(falling), ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace viapoint
