#include "viapoint/path/insertion.hpp"

#include <gtest/gtest.h>

#include "path/insertion_checks.hpp"
#include "problem_count.hpp"

namespace viapoint {
namespace {

using testing::expect_sound;
using testing::joints_b;
using testing::joints_c;
using testing::joints_in_degrees;
using testing::problem_of;
using testing::random_line;
using testing::RandomLine;

TEST(InsertCurve, StaysWithinToleranceOnThousandsOfLines) {
  const ForwardKinematics arm = testing::puma560();
  const JointLimits limits = testing::puma560_limits();
  int inserted = 0;
  for (unsigned seed = 0; seed < problems(4000U); ++seed) {
    SCOPED_TRACE(seed);
    const RandomLine line = random_line(arm, limits, seed, 0.05 + 0.25 * (seed % 4));
    const InsertionOptions options;
    try {
      const Insertion found = insert_curve(arm, limits, line.curve, line.start, options);
      // All pieces of every tenth line on 1000 samples, the others on fewer.
      ASSERT_NO_FATAL_FAILURE(
          expect_sound(arm, limits, line.curve, found, options, seed % 10 == 0 ? 1000 : 40));
      ++inserted;
    } catch (const MotionError& error) {
      const ErrorCode code = error.code();
      ASSERT_TRUE(code == ErrorCode::kJointLimit || code == ErrorCode::kUnreachable ||
                  code == ErrorCode::kSingular)
          << error.what();
      ASSERT_TRUE(error.problem().share.has_value());
      ASSERT_GE(*error.problem().share, 0.0);
      ASSERT_LE(*error.problem().share, 1.0);
    }
  }
  EXPECT_GT(inserted, problems(1000));
}

TEST(InsertCurve, KeepsTightTolerancesOfPositionAndAngleApart) {
  const ForwardKinematics arm = testing::puma560();
  const JointLimits limits = testing::no_position_limits(6);
  const JointLimits range = testing::puma560_limits();
  int inserted = 0;
  for (unsigned seed = 0; seed < problems(300U); ++seed) {
    SCOPED_TRACE(seed);
    const RandomLine line = random_line(arm, range, seed, 0.3);
    InsertionOptions options;
    options.position_tolerance = seed % 2 == 0 ? 1e-9 : 1e-2;
    options.angle_tolerance = seed % 2 == 0 ? 1e-2 : 1e-9;
    try {
      const Insertion found = insert_curve(arm, limits, line.curve, line.start, options);
      ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, line.curve, found, options, 50));
      ++inserted;
    } catch (const MotionError& error) {
      ASSERT_TRUE(error.code() == ErrorCode::kUnreachable || error.code() == ErrorCode::kSingular)
          << error.what();
    }
  }
  EXPECT_GT(inserted, problems(200));
}

TEST(InsertCurve, HoldsTheTextbooksSecondLegWithTheWristInterpolated) {  // textbook §3
  const ForwardKinematics arm = testing::puma560();
  const JointLimits limits = testing::puma560_limits();
  InsertionOptions options;
  options.hold = Hold::kWrist;
  options.wrist_goal = joints_c();
  const LineCurve curve(arm.pose(joints_b()), arm.pose(joints_c()));
  const Insertion found = insert_curve(arm, limits, curve, joints_b(), options);
  ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, curve, found, options, 1000));
  EXPECT_LT((found.knots.back() - joints_c()).lpNorm<Eigen::Infinity>(), 1e-9);
}

TEST(InsertCurve, CountsTheToolInAWristInterpolatedLine) {
  // With a long tool the wrist joints move the tool point, and the first three must make up for it.
  Pose tool = Pose::Identity();
  tool.translation() = Eigen::Vector3d(0.05, 0.02, 0.2);
  const ForwardKinematics arm = testing::chain_from_dh({{0, 0, -kPi / 2},
                                                        {0, 0.432, 0},
                                                        {0.149, -0.02, kPi / 2},
                                                        {0.433, 0, -kPi / 2},
                                                        {0, 0, kPi / 2},
                                                        {0, 0, 0}},
                                                       tool);
  const JointLimits limits = testing::no_position_limits(6);
  const JointVector q0 = joints_in_degrees({10, 40, 20, 30, 40, 10});
  const JointVector q1 = joints_in_degrees({40, 20, 40, -60, 70, 90});
  InsertionOptions options;
  options.hold = Hold::kWrist;
  options.wrist_goal = q1;
  const LineCurve curve(arm.pose(q0), arm.pose(q1));
  const Insertion found = insert_curve(arm, limits, curve, q0, options);
  ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, curve, found, options, 1000));
  EXPECT_LT((found.knots.back() - q1).lpNorm<Eigen::Infinity>(), 1e-9);
}

TEST(InsertCurve, HoldsThePositionWithFewJoints) {
  InsertionOptions options;
  options.hold = Hold::kPosition;
  {
    // Textbook §5: the two-link arm from (3, 0) outwards cannot leave; from elbow bent it goes.
    const ForwardKinematics arm = testing::two_link();
    JointVector q(2);
    q << 72.88556683609372 * kDegree, -41.409622109270856 * kDegree;
    const Pose from = arm.pose(q);
    ASSERT_NEAR((from.translation() - Eigen::Vector3d(2, 2, 0)).norm(), 0.0, 1e-12);
    const LineCurve curve = LineCurve::fixed_orientation(from, Eigen::Vector3d(1.2, 0.9, 0.0));
    const JointLimits limits = testing::no_position_limits(2);
    const Insertion found = insert_curve(arm, limits, curve, q, options);
    ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, curve, found, options, 300));
    const LineCurve lifted = LineCurve::fixed_orientation(from, Eigen::Vector3d(1.2, 0.9, 0.3));
    const auto problem = problem_of(arm, limits, lifted, q, options);
    ASSERT_TRUE(problem);
    EXPECT_EQ(problem->code, ErrorCode::kUncontrolled);
    EXPECT_NE(problem->message.find("hold z"), std::string::npos) << problem->message;
  }
  {
    const ForwardKinematics arm = testing::rpp();  // textbook §5
    JointVector q(3);
    q << 0.0, 0.0, 0.2;
    const Pose from = arm.pose(q);
    ASSERT_NEAR((from.translation() - Eigen::Vector3d(0, 0.2, 0.5)).norm(), 0.0, 1e-12);
    const LineCurve curve = LineCurve::fixed_orientation(from, Eigen::Vector3d(1.0, 1.2, 0.5));
    const JointLimits limits = testing::no_position_limits(3);
    const Insertion found = insert_curve(arm, limits, curve, q, options);
    ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, curve, found, options, 300));
    EXPECT_NEAR(found.knots.back()[0], std::atan2(-1.0, 1.2), 1e-8);
  }
}

TEST(InsertCurve, FollowsWithARedundantArm) {
  const ForwardKinematics arm = testing::seven_joints();
  const JointLimits limits = testing::no_position_limits(7);
  const JointLimits range = testing::symmetric_limits(JointVector::Constant(7, 1.5));
  size_t pieces = 0;
  int inserted = 0;
  for (unsigned seed = 0; seed < problems(200U); ++seed) {
    SCOPED_TRACE(seed);
    const RandomLine line = random_line(arm, range, seed, 0.2);
    try {
      const Insertion found = insert_curve(arm, limits, line.curve, line.start, {});
      ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, line.curve, found, {}, 50));
      pieces += found.pieces.size();
      ++inserted;
    } catch (const MotionError& error) {
      ASSERT_TRUE(error.code() == ErrorCode::kUnreachable || error.code() == ErrorCode::kSingular)
          << error.what();
    }
  }
  EXPECT_GT(inserted, problems(150));
  EXPECT_LT(pieces, 20u * static_cast<size_t>(inserted));
}

}  // namespace
}  // namespace viapoint
