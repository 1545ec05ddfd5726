#include <gtest/gtest.h>

#include "path/insertion_checks.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint {
namespace {

using testing::expect_sound;
using testing::joints_a;
using testing::joints_b;
using testing::joints_c;
using testing::joints_in_degrees;
using testing::problem_of;

TEST(InsertCurve, FindsJoint4LeavingItsLimitOnTheTextbooksSecondLeg) {  // textbook §3
  const ForwardKinematics arm = testing::puma560();
  const JointLimits limits = testing::puma560_limits();
  // A→B arrives at B on the other wrist branch.
  const LineCurve a_to_b(arm.pose(joints_a()), arm.pose(joints_b()));
  const Insertion first = insert_curve(arm, limits, a_to_b, joints_a(), {});
  const JointVector b = first.knots.back();
  EXPECT_NEAR(b[3] / kDegree, 58.6, 0.05);
  EXPECT_NEAR(b[4] / kDegree, 11.5, 0.05);
  EXPECT_NEAR(b[5] / kDegree, 1.5, 0.05);
  // From there joint 4 passes 140° at 74 % of the way to C, and would go on to 195°.
  const LineCurve b_to_c(arm.pose(joints_b()), arm.pose(joints_c()));
  const auto problem = problem_of(arm, limits, b_to_c, b);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kJointLimit);
  EXPECT_EQ(problem->joint, 3);
  EXPECT_NEAR(*problem->share, 0.74, 0.005);
  EXPECT_DOUBLE_EQ(*problem->limit, 140 * kDegree);
  EXPECT_NEAR(*problem->value / kDegree, 195.0, 0.5);
  EXPECT_GE(problem->ways_out.size(), 2u);
  // From the printed branch of B it leaves at 12 %.
  const auto printed = problem_of(arm, limits, b_to_c, joints_b());
  ASSERT_TRUE(printed);
  EXPECT_EQ(printed->code, ErrorCode::kJointLimit);
  EXPECT_NEAR(*printed->share, 0.12, 0.005);
}

TEST(InsertCurve, TellsWhereTheLineLeavesTheWorkspace) {
  const ForwardKinematics arm = testing::puma560();
  const JointVector q0 = joints_in_degrees({10, 40, 20, 30, 40, 10});
  const Pose from = arm.pose(q0);
  // Radially outwards: reach from the shoulder point at height 0 is exact.
  const Eigen::Vector3d to = from.translation() * 3.0;
  const LineCurve curve = LineCurve::fixed_orientation(from, to);
  const auto problem = problem_of(arm, testing::no_position_limits(6), curve, q0);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kUnreachable);
  // Wrist centre at hypot(0.149, r): r = 0.432 + |(0.433, 0.02)| stretched.
  const double reach = std::hypot(0.149, 0.432 + std::hypot(0.433, 0.02));
  const double expected = (reach - from.translation().norm()) / curve.length();
  EXPECT_NEAR(*problem->share, expected, 2e-6);
  EXPECT_GT(*problem->value, 0.0);
}

TEST(InsertCurve, RefusesAGoalFarBeyondTheArmAtOnce) {
  const ForwardKinematics arm = testing::puma560();
  const JointVector q0 = joints_in_degrees({10, 40, 20, 30, 40, 10});
  const Pose from = arm.pose(q0);
  for (const double far : {1e3, 1e9, 1e154, 1e155, 1e300}) {
    SCOPED_TRACE(far);
    const LineCurve curve = LineCurve::fixed_orientation(from, Eigen::Vector3d(far, 0.0, -far));
    const auto problem = problem_of(arm, testing::puma560_limits(), curve, q0);
    ASSERT_TRUE(problem);
    EXPECT_EQ(problem->code, ErrorCode::kUnreachable);
    EXPECT_NEAR(*problem->value / far, std::sqrt(2.0), 1e-9);
    // 0.149 + 0.432 + |(0.02, 0.149)| + 0.433 holds every stretch of the arm.
    EXPECT_LT(*problem->limit, 1.2);
    EXPECT_GT(*problem->limit, 0.865);
    ASSERT_TRUE(problem->share);
    EXPECT_LT(*problem->share, std::max(2.0 / far, 1e-18));
  }
}

TEST(InsertCurve, EndsOnHugeTargetsOfAnArmWithoutAReach) {
  JointLimits limits = testing::no_position_limits(3);
  const ForwardKinematics arm = testing::rpp();
  JointVector q(3);
  q << 0.0, 0.0, 0.2;
  InsertionOptions options;
  options.hold = Hold::kPosition;
  for (const double far : {1e20, 1e155, 1e300}) {
    SCOPED_TRACE(far);
    const Pose from = arm.pose(q);
    const LineCurve curve = LineCurve::fixed_orientation(from, Eigen::Vector3d(far, far, 0.5));
    const auto problem = problem_of(arm, limits, curve, q, options);
    ASSERT_TRUE(problem);
    EXPECT_TRUE(problem->share.has_value());
  }
}

TEST(InsertCurve, TellsTheHoleAroundTheFirstAxis) {
  const ForwardKinematics arm = testing::puma560();
  const JointVector q0 = joints_in_degrees({0, -20, 100, 10, 40, 10});
  const Pose from = arm.pose(q0);
  const Eigen::Vector3d p = from.translation();
  const LineCurve curve =
      LineCurve::fixed_orientation(from, Eigen::Vector3d(-p.x(), -p.y(), p.z()));
  const auto problem = problem_of(arm, testing::no_position_limits(6), curve, q0);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kUnreachable);
  const double radius = p.head<2>().norm();
  EXPECT_NEAR(*problem->share, (radius - 0.149) / (2.0 * radius), 1e-5);
}

TEST(InsertCurve, TellsAWristThatMustJump) {
  // Towards q5 = 0 along a direction that q4 cannot serve: beyond it only the flipped wrist goes
  // on.
  const ForwardKinematics arm = testing::puma560();
  const JointVector at = joints_in_degrees({10, 40, 20, 0, 0, 0});
  const Pose middle = arm.pose(at);
  // Turning about the axis across q5's leaves the reach of the joints at once.
  const Eigen::Vector3d across = arm.frames(at).axis[4].cross(arm.frames(at).axis[3]);
  Pose to = middle;
  to.linear() = rotation_exp(0.3 * across) * middle.linear();
  const LineCurve curve(middle, to);
  const auto problem = problem_of(arm, testing::no_position_limits(6), curve, at);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kSingular);
  EXPECT_NEAR(*problem->share, 0.0, 1e-6);
}

TEST(InsertCurve, PassesThroughASingularityThatTheJointsCanCross) {
  // About q5's own axis through q5 = 0: singular in the middle, and every joint moves smoothly.
  const ForwardKinematics arm = testing::puma560();
  const JointVector start = joints_in_degrees({10, 40, 20, 0, -20, 0});
  const JointVector goal = joints_in_degrees({10, 40, 20, 0, 20, 0});
  const LineCurve curve(arm.pose(start), arm.pose(goal));
  const JointLimits limits = testing::no_position_limits(6);
  const Insertion found = insert_curve(arm, limits, curve, start, {});
  ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, curve, found, {}, 200));
  EXPECT_LT((found.knots.back() - goal).norm(), 1e-6);
}

TEST(InsertCurve, StartsAtASingularPoseThatTheJointsCanLeave) {
  const ForwardKinematics arm = testing::puma560();
  const JointVector start = joints_in_degrees({10, 40, 20, 0, 0, 0});
  const Pose from = arm.pose(start);
  // In the plane of joints 2 and 3 the wrist only has to turn about q5.
  const Eigen::Vector3d sideways = arm.frames(start).axis[1];
  Eigen::Vector3d to = from.translation();
  to += 0.1 * sideways.cross(Eigen::Vector3d::UnitZ());
  const LineCurve curve = LineCurve::fixed_orientation(from, to);
  const JointLimits limits = testing::no_position_limits(6);
  const Insertion found = insert_curve(arm, limits, curve, start, {});
  ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, curve, found, {}, 200));
  EXPECT_LT(found.pieces.size(), 20u);
}

TEST(InsertCurve, GoesOnCloseByASingularity) {
  const ForwardKinematics arm = testing::puma560();
  const JointLimits limits = testing::no_position_limits(6);
  for (const double aside : {1e-2, 1e-3, 1e-4, 1e-5}) {
    SCOPED_TRACE(aside);
    JointVector near = joints_in_degrees({10, 40, 20, 0, 0, 0});
    near[4] = aside;
    const Pose middle = arm.pose(near);
    const Eigen::Vector3d across = arm.frames(near).axis[4].cross(arm.frames(near).axis[3]);
    Pose from = middle;
    from.linear() = rotation_exp(-0.2 * across) * middle.linear();
    Pose to = middle;
    to.linear() = rotation_exp(0.2 * across) * middle.linear();
    // Half of the way out tells the start.
    const LineCurve back(middle, from);
    const JointVector start = insert_curve(arm, limits, back, near, {}).knots.back();
    const LineCurve curve(from, to);
    const Insertion found = insert_curve(arm, limits, curve, start, {});
    ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, curve, found, {}, 100));
    // Joint 4 turns by nearly half a turn within about `aside`, unless the tolerance of the angle
    // (1.7e-4) lets the wrist go straight through.
    const double turn = std::abs(found.knots.back()[3] - start[3]);
    if (aside > 1e-3 / 2) {
      EXPECT_GT(turn, kPi - 0.2);
    } else {
      EXPECT_TRUE(turn > kPi - 0.2 || turn < 0.1) << turn;
    }
  }
}

TEST(InsertCurve, NamesTheCoordinatesThatFourAxesCannotHold) {
  const ForwardKinematics arm = testing::scara();
  const JointLimits limits = testing::no_position_limits(4);
  JointVector q(4);
  q << 0.3, 0.8, 0.1, -0.4;
  const Pose from = arm.pose(q);
  Pose tilted = from;
  tilted.translation() += Eigen::Vector3d(0.05, 0.05, 0.0);
  tilted.linear() = rotation_exp(Eigen::Vector3d(0.2, 0.0, 0.0)) * from.linear();
  const auto problem = problem_of(arm, limits, LineCurve(from, tilted), q);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kUncontrolled);
  EXPECT_NE(problem->message.find("cannot hold rotation about x;"), std::string::npos)
      << problem->message;
  EXPECT_NE(problem->message.find("can hold there: x, y, z, rotation about z"), std::string::npos)
      << problem->message;
  // A turn about the vertical is within what it holds.
  Pose turned = from;
  turned.translation() += Eigen::Vector3d(-0.05, -0.05, -0.1);
  turned.linear() = rotation_exp(Eigen::Vector3d(0.0, 0.0, 0.5)) * from.linear();
  const LineCurve curve(from, turned);
  const Insertion found = insert_curve(arm, limits, curve, q, {});
  ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, curve, found, {}, 300));
}

TEST(InsertCurve, HoldsCoupledLimits) {
  const ForwardKinematics arm = testing::puma560();
  JointLimits limits = testing::no_position_limits(6);
  limits.coupling.setZero(1, 6);
  limits.coupling(0, 1) = 1.0;
  limits.coupling(0, 2) = -1.0;
  const JointVector q0 = joints_in_degrees({10, 40, 20, 30, 40, 10});
  const Pose from = arm.pose(q0);
  const LineCurve curve =
      LineCurve::fixed_orientation(from, from.translation() + Eigen::Vector3d(0.0, 0.0, -0.2));
  limits.coupling_lower = CouplingVector::Constant(1, -10.0);
  limits.coupling_upper = CouplingVector::Constant(1, 10.0);
  const Insertion found = insert_curve(arm, limits, curve, q0, {});
  const JointVector& end = found.knots.back();
  // A limit half way between the values at start and end must be crossed on the way.
  const double at_start = q0[1] - q0[2];
  const double at_end = end[1] - end[2];
  const double limit = 0.5 * (at_start + at_end);
  if (at_end > at_start) {
    limits.coupling_upper[0] = limit;
  } else {
    limits.coupling_lower[0] = limit;
  }
  const auto problem = problem_of(arm, limits, curve, q0);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kCouplingLimit);
  EXPECT_FALSE(problem->joint.has_value());
  EXPECT_DOUBLE_EQ(*problem->limit, limit);
  double farthest = at_start;
  for (const JointPiece& piece : found.pieces) {
    for (int i = 0; i <= 1000; ++i) {
      const JointVector q = piece.at(piece.length * i / 1000).q;
      const double value = q[1] - q[2];
      farthest = at_end > at_start ? std::max(farthest, value) : std::min(farthest, value);
    }
  }
  EXPECT_NEAR(*problem->value, farthest, 1e-6);
  ASSERT_GT(*problem->share, 0.01);
  ASSERT_LT(*problem->share, 0.99);
  // At that share the coupled value is the limit.
  double s = *problem->share * curve.length();
  for (const JointPiece& piece : found.pieces) {
    if (s <= piece.length) {
      const JointVector q = piece.at(s).q;
      EXPECT_NEAR(q[1] - q[2], limit, 1e-6);
      break;
    }
    s -= piece.length;
  }
}

TEST(InsertCurve, RefusesACurveThatGoesNowhere) {
  const ForwardKinematics arm = testing::puma560();
  const Pose pose = arm.pose(joints_b());
  const LineCurve curve(pose, pose);
  EXPECT_EQ(curve.length(), 0.0);
  const auto problem = problem_of(arm, testing::puma560_limits(), curve, joints_b());
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kZeroLength);
  EXPECT_THROW((void)taylor_insertion(arm, curve, joints_b(), joints_b(), 1e-3, 1e-2), MotionError);
}

TEST(InsertCurve, RefusesAStartThatIsNotOnTheCurve) {
  const ForwardKinematics arm = testing::puma560();
  const LineCurve curve(arm.pose(joints_b()), arm.pose(joints_c()));
  const auto problem = problem_of(arm, testing::no_position_limits(6), curve, joints_a());
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kDiscontinuous);
}

TEST(InsertCurve, RefusesArgumentsThatMakeNoSense) {
  const ForwardKinematics arm = testing::puma560();
  const JointLimits limits = testing::puma560_limits();
  const LineCurve curve(arm.pose(joints_b()), arm.pose(joints_c()));
  const auto code = [&](const JointVector& start, const InsertionOptions& options) {
    const auto problem = problem_of(arm, limits, curve, start, options);
    return problem ? problem->code : ErrorCode::kInternal;
  };
  InsertionOptions options;
  EXPECT_EQ(code(JointVector::Zero(5), options), ErrorCode::kBadArgument);
  JointVector broken = joints_b();
  broken[2] = std::nan("");
  EXPECT_EQ(code(broken, options), ErrorCode::kBadArgument);
  options.position_tolerance = 0.0;
  EXPECT_EQ(code(joints_b(), options), ErrorCode::kBadArgument);
  options = {};
  options.hold = Hold::kWrist;
  EXPECT_EQ(code(joints_b(), options), ErrorCode::kBadArgument);
}

TEST(InsertCurve, ALimitAtTheStartIsNoBreach) {
  const ForwardKinematics arm = testing::puma560();
  const JointVector q0 = joints_in_degrees({10, 40, 20, 30, 40, 10});
  const JointVector q1 = joints_in_degrees({12, 38, 22, 25, 42, 14});
  JointLimits limits = testing::no_position_limits(6);
  limits.position_min[0] = q0[0];
  limits.position_max[1] = q0[1];
  const LineCurve curve(arm.pose(q0), arm.pose(q1));
  EXPECT_NO_THROW((void)insert_curve(arm, limits, curve, q0, {}));
}

}  // namespace
}  // namespace viapoint
