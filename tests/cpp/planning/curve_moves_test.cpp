// Arcs and turns as moves of a program, and curves among one another.
#include <gtest/gtest.h>

#include <cmath>

#include "planning/curve_fixture.hpp"
#include "planning/planner_fixture.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;
using Eigen::Vector3d;

/// Largest distance of the tool from `center` beyond `radius`, both ways, and from the plane.
double off_the_circle(const RobotModel& arm, const PlannedMotion& motion, const Vector3d& center,
                      const Vector3d& normal, double radius) {
  double worst = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    const Vector3d from = tool_at(arm, motion, i / 2000.0).translation() - center;
    worst = std::max(worst, std::hypot(std::abs(from.norm() - radius), normal.dot(from)));
  }
  return worst;
}

TEST(CircMove, KeepsItsCircleAndItsOrientation) {
  const RobotPtr puma = robot("puma560");
  const Vector3d at = puma->forward().pose(home()).translation();
  const Vector3d center = at + Vector3d(0.0, 0.06, 0.0);
  Script script(*puma, home());
  const Pose via = moved(*puma, home(), {0.06, 0.06, 0.0});
  Pose end = moved(*puma, home(), {0.0, 0.12, 0.0});
  end.linear() = rotation_exp({0.1, 0.3, -0.2}) * end.linear();
  script.add(CircMove{PoseTarget{via}, PoseTarget{end}});
  const PlannedMotion motion = MotionPlanner(puma).plan(script.program());
  EXPECT_TRUE(motion.trajectory.certificate().holds());
  EXPECT_LE(off_the_circle(*puma, motion, center, Vector3d::UnitZ(), 0.06), 5e-5);
  const Pose last = tool_at(*puma, motion, 1.0);
  EXPECT_LT((last.translation() - end.translation()).norm(), 1e-7);
  EXPECT_LT(rotation_distance(last.linear(), end.linear()), 1e-6);
}

TEST(CircMove, PassesTheOrientationOfItsViaPointWhereAsked) {
  const RobotPtr puma = robot("puma560");
  Pose via = moved(*puma, home(), {0.06, 0.06, 0.0});
  via.linear() = rotation_exp({0.2, 0.0, 0.1}) * via.linear();
  const Pose end = moved(*puma, home(), {0.0, 0.12, 0.0});
  for (const Orientation way : {Orientation::kThrough, Orientation::kLeast}) {
    Script script(*puma, home());
    script.add(CircMove{PoseTarget{via}, PoseTarget{end}, way});
    const PlannedMotion motion = MotionPlanner(puma).plan(script.program());
    double nearest = 1.0;
    for (int i = 0; i <= 4000; ++i) {
      const Pose pose = tool_at(*puma, motion, i / 4000.0);
      if ((pose.translation() - via.translation()).norm() > 2e-4) continue;
      nearest = std::min(nearest, rotation_distance(pose.linear(), via.linear()));
    }
    if (way == Orientation::kThrough) {
      EXPECT_LT(nearest, 2e-3);
    } else {
      EXPECT_GT(nearest, 0.2);
    }
  }
}

TEST(CircMove, RefusesPointsOnOneLineWithTheWayOut) {
  const RobotPtr puma = robot("puma560");
  Script script(*puma, home());
  script.add(CircMove{PoseTarget{moved(*puma, home(), {0.03, 0.03, 0.0})},
                      PoseTarget{moved(*puma, home(), {0.06, 0.06, 0.0})}});
  const Problem problem = only_problem(puma, script.program());
  EXPECT_EQ(problem.code, ErrorCode::kDegenerateCurve);
  EXPECT_EQ(problem.line, 1);
  EXPECT_NE(problem.describe().find("movel"), std::string::npos) << problem.describe();
}

TEST(TurnMove, GoesRoundAsOftenAsAsked) {
  const RobotPtr puma = robot("puma560");
  const Vector3d at = puma->forward().pose(home()).translation();
  Script script(*puma, home());
  TurnMove move;
  move.center = at + Vector3d(0.04, 0.0, 0.0);
  move.axis = Vector3d(0.0, 0.0, 2.0);
  move.angle = 5.0 * kPi;
  move.pitch = 0.004;
  script.add(move);
  const PlannedMotion motion = MotionPlanner(puma).plan(script.program());
  const Pose last = tool_at(*puma, motion, 1.0);
  EXPECT_LT((last.translation() - (at + Vector3d(0.08, 0.0, 0.01))).norm(), 1e-7);
  EXPECT_LT(rotation_distance(last.linear(), puma->forward().pose(home()).linear()), 1e-6);
  double turned = 0.0;
  Vector3d before = at - *move.center;
  for (int i = 1; i <= 2000; ++i) {
    Vector3d now = tool_at(*puma, motion, i / 2000.0).translation() - *move.center;
    now.z() = before.z() = 0.0;
    turned += std::atan2(before.cross(now).z(), before.dot(now));
    before = now;
  }
  EXPECT_NEAR(turned, 5.0 * kPi, 1e-3);
}

TEST(TurnMove, ScrewsTheToolAboutItsOwnAxis) {
  const RobotPtr puma = robot("puma560");
  const Pose from = puma->forward().pose(home());
  Script script(*puma, home());
  TurnMove move;
  move.angle = -2.0;
  move.pitch = 0.02;
  move.orientation = Orientation::kTangent;
  script.add(move);
  const PlannedMotion motion = MotionPlanner(puma).plan(script.program());
  const Vector3d axis = from.linear().col(2);
  for (int i = 0; i <= 200; ++i) {
    const Pose pose = tool_at(*puma, motion, i / 200.0);
    const Vector3d travel = pose.translation() - from.translation();
    // The thread: travel and turn go together.
    const double angle = axis.dot(travel) / 0.02 * 2.0 * kPi;
    EXPECT_LT((travel - axis * axis.dot(travel)).norm(), 5e-5);
    EXPECT_LT(rotation_distance(pose.linear(), rotation_exp(axis * angle) * from.linear()), 0.02);
  }
  EXPECT_LT(rotation_distance(tool_at(*puma, motion, 1.0).linear(),
                              rotation_exp(-2.0 * axis) * from.linear()),
            1e-6);
}

TEST(TurnMove, RefusesWhatMeansNothing) {
  const RobotPtr puma = robot("puma560");
  const auto problem_with = [&](const TurnMove& move) {
    Script script(*puma, home());
    script.add(move);
    script.movej(degrees({10, 20, 0, 15, 50, 10}));
    return only_problem(puma, script.program());
  };
  TurnMove least;
  least.angle = 1.0;
  least.orientation = Orientation::kLeast;
  EXPECT_EQ(problem_with(least).code, ErrorCode::kBadArgument);
  TurnMove far;
  far.angle = 1e5;
  EXPECT_EQ(problem_with(far).code, ErrorCode::kBadArgument);
  TurnMove still;
  still.angle = 1.0;
  const Problem nowhere = problem_with(still);
  EXPECT_EQ(nowhere.code, ErrorCode::kZeroLength);
  EXPECT_EQ(nowhere.severity, Severity::kWarning);
  TurnMove flat;
  flat.angle = 1.0;
  flat.center = Vector3d(0.1, 0.1, 0.1);
  flat.axis = Vector3d::Zero();
  EXPECT_EQ(problem_with(flat).code, ErrorCode::kDegenerateCurve);
}

TEST(CurveMoves, BlendWithLinesAndWithOneAnother) {
  const RobotPtr puma = robot("puma560");
  Script script(*puma, home());
  MoveOptions rounded;
  rounded.zone = {ZoneKind::kRadius, 0.01};
  script.add(LinMove{PoseTarget{moved(*puma, home(), {0.06, 0.0, 0.0})}}, rounded);
  script.add(CircMove{PoseTarget{moved(*puma, home(), {0.09, 0.03, 0.0})},
                      PoseTarget{moved(*puma, home(), {0.06, 0.06, 0.0})}},
             rounded);
  script.add(CircMove{PoseTarget{moved(*puma, home(), {0.03, 0.05, 0.01})},
                      PoseTarget{moved(*puma, home(), {0.0, 0.06, 0.0})}},
             rounded);
  script.add(through({moved(*puma, home(), {-0.03, 0.03, 0.0}), moved(*puma, home(), {0, 0, 0})}));
  const PlannedMotion motion = MotionPlanner(puma).plan(script.program());
  EXPECT_TRUE(motion.trajectory.certificate().holds());
  ASSERT_EQ(motion.corners.size(), 3u);
  for (const CornerOutcome& corner : motion.corners) {
    EXPECT_FALSE(corner.stopped) << corner.move << ": " << corner.reason;
    EXPECT_LE(corner.used, 0.01 * (1 + 1e-12));
  }
}

TEST(CurveMoves, KeepASpeedOfTheToolThatIsAskedFor) {
  const RobotPtr puma = robot("puma560");
  const Vector3d at = puma->forward().pose(home()).translation();
  MoveOptions slow;
  slow.speed = 0.1;
  TurnMove move;
  move.center = at + Vector3d(0.05, 0.0, 0.0);
  move.axis = Vector3d::UnitZ();
  move.angle = 2.0 * kPi;
  Script script(*puma, home());
  script.add(move, slow);
  const Trajectory trajectory = MotionPlanner(puma).plan(script.program()).trajectory;
  double fastest = 0.0;
  for (int i = 0; i <= 5000; ++i) {
    const JointState state = trajectory.at(trajectory.duration() * i / 5000.0);
    const ChainFrames frames = puma->forward().frames(state.q);
    fastest = std::max(fastest, (puma->forward().jacobian(frames).topRows<3>() * state.qd).norm());
  }
  EXPECT_LE(fastest, 0.1 * (1 + 1e-6));
  EXPECT_GT(fastest, 0.095);
}

TEST(CurveMoves, TellAnArmOfFourAxesWhatItCannotHold) {
  const RobotPtr scara = robot("scara");
  JointVector start(4);
  start << 0.3, 0.8, 0.15, -0.4;
  const Vector3d at = scara->forward().pose(start).translation();
  Script flat(*scara, start);
  TurnMove move;
  move.center = at - 0.03 * Vector3d(at.x(), at.y(), 0.0).normalized();
  move.axis = Vector3d::UnitZ();
  move.angle = 2.0 * kPi;
  flat.add(move);
  const Report report = MotionPlanner(scara).check(flat.program());
  EXPECT_TRUE(report.ok()) << report.describe();
  move.axis = Vector3d::UnitX();
  move.center = at + Vector3d(0.0, 0.03, 0.0);
  move.angle = 1.0;
  move.orientation = Orientation::kTangent;
  Script tilted(*scara, start);
  tilted.add(move);
  const Problem problem = only_problem(scara, tilted.program());
  EXPECT_EQ(problem.code, ErrorCode::kUncontrolled);
  EXPECT_NE(problem.message.find("cannot hold rotation about x"), std::string::npos)
      << problem.message;
  EXPECT_NE(problem.message.find("can hold there: x, y, z, rotation about z"), std::string::npos)
      << problem.message;
}

TEST(CurveMoves, NameTheBranchWhereTheEndHasAnother) {
  const RobotPtr puma = robot("puma560");
  const JointVector end = degrees({10, 20, 5, 20, 45, 0});
  const auto branches = puma->inverse().solve_all(puma->forward().pose(end));
  const Pose via = moved(*puma, degrees({5, 23, 2, 17, 47, 5}), {0.0, 0.0, 0.03});
  int others = 0;
  for (const JointVector& q : branches) {
    Script script(*puma, home());
    script.add(CircMove{PoseTarget{via}, JointTarget{q}});
    const Report report = MotionPlanner(puma).check(script.program());
    if ((q - end).cwiseAbs().maxCoeff() < 1e-3) {
      EXPECT_TRUE(report.ok()) << report.describe();
      continue;
    }
    ++others;
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(report.problems[0].code, ErrorCode::kBranchChange);
    EXPECT_NE(report.problems[0].describe().find("movej"), std::string::npos);
  }
  EXPECT_GT(others, 0);
}

TEST(CurveMoves, GoOnFromTheirGoalAfterAFault) {
  // The arc cannot be followed; the line behind it starts where the arc was to end.
  const RobotPtr puma = robot("puma560");
  const Pose end = moved(*puma, home(), {0.0, 0.1, 0.0});
  Script script(*puma, home());
  script.add(CircMove{PositionTarget{{3.0, 0.0, 0.0}}, PoseTarget{end}});
  script.add(LinMove{PoseTarget{end}});
  const Report report = MotionPlanner(puma).check(script.program());
  ASSERT_EQ(report.problems.size(), 2u) << report.describe();
  EXPECT_EQ(report.problems[0].code, ErrorCode::kUnreachable);
  EXPECT_NE(report.problems[0].describe().find("movej"), std::string::npos);
  EXPECT_EQ(report.problems[1].code, ErrorCode::kZeroLength);
}

}  // namespace
}  // namespace viapoint
