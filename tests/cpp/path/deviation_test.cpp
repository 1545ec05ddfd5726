#include <gtest/gtest.h>

#include "path/insertion_checks.hpp"
#include "problem_count.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint {
namespace {

using testing::joints_in_degrees;
using testing::random_line;
using testing::RandomLine;
using testing::sampled;

TEST(BoundDeviation, IsNeverBelowAndWithinItsResolutionOfTheTruth) {
  const ForwardKinematics arm = testing::puma560();
  const JointLimits limits = testing::puma560_limits();
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    // Any joint line against the tool line between its ends: deviations up to decimetres.
    std::mt19937 random(seed);
    const JointVector q0 = testing::random_joints(random, limits);
    const JointVector q1 =
        q0 + (0.02 + 0.1 * (seed % 5)) * (testing::random_joints(random, limits) - q0);
    const LineCurve curve(arm.pose(q0), arm.pose(q1));
    const JointPiece piece = JointPiece::line(q0, q1, curve.length());
    constexpr double kResolution = 1e-5;
    const Deviation bound = bound_deviation(arm, piece, curve, 0.0, kResolution, kResolution);
    const Deviation truth = sampled(arm, piece, curve, 0.0, 1000);
    ASSERT_GE(bound.position, truth.position - 1e-13);
    ASSERT_GE(bound.angle, truth.angle - 1e-13);
    // Samples 1/1000 apart see the maximum to a small part of it.
    ASSERT_LE(bound.position, truth.position * (1.0 + 1e-4) + kResolution);
    // The angle has a cusp at half a turn, which samples cut off.
    if (truth.angle < 3.0) {
      ASSERT_LE(bound.angle, truth.angle * (1.0 + 1e-4) + kResolution);
    }
  }
}

TEST(BoundDeviation, HoldsForPrismaticAndRedundantArms) {
  for (const ForwardKinematics& arm : {testing::scara(), testing::rpp(), testing::seven_joints()}) {
    JointVector range = JointVector::Constant(arm.joints(), 2.0);
    for (int i = 0; i < arm.joints(); ++i) {
      if (arm.type(i) == JointType::kPrismatic) range[i] = 0.5;
    }
    const JointLimits limits = testing::symmetric_limits(range);
    for (unsigned seed = 0; seed < 1000; ++seed) {
      SCOPED_TRACE(seed);
      std::mt19937 random(seed);
      PathPoint from{testing::random_joints(random, limits),
                     testing::random_joints(random, limits),
                     testing::random_joints(random, limits),
                     {}};
      PathPoint to{testing::random_joints(random, limits),
                   testing::random_joints(random, limits),
                   testing::random_joints(random, limits),
                   {}};
      to.q = from.q + 0.2 * (to.q - from.q);
      const LineCurve curve(arm.pose(from.q), arm.pose(to.q));
      const JointPiece piece = JointPiece::hermite(from, to, curve.length());
      const Deviation bound = bound_deviation(arm, piece, curve, 0.0, 1e-4, 1e-4);
      const Deviation truth = sampled(arm, piece, curve, 0.0, 300);
      ASSERT_GE(bound.position, truth.position - 1e-13);
      ASSERT_GE(bound.angle, truth.angle - 1e-13);
      ASSERT_LE(bound.position, truth.position * 1.01 + 1e-4);
      ASSERT_LE(bound.angle, truth.angle * 1.01 + 1e-4);
    }
  }
}

TEST(BoundDeviation, SeesTheSShapedErrorThatTheMidpointTestIsBlindTo) {
  // A quintic whose error changes sign in the middle: exact at both ends and at the midpoint.
  const ForwardKinematics arm = testing::puma560();
  const JointVector q0 = joints_in_degrees({10, 40, 20, 30, 40, 10});
  const JointVector slope = JointVector::Constant(6, 0.3);
  const PathPoint from{q0, slope, JointVector::Zero(6), {}};
  const JointPiece piece = JointPiece::hermite(from, {q0, slope, JointVector::Zero(6), {}}, 1.0);
  const Pose middle = arm.pose(piece.at(0.5).q);
  // The curve stands still at the pose of ends and middle, but for a turn of 1e-6 that gives it
  // length.
  Pose end = middle;
  end.rotate(Eigen::AngleAxisd(1e-6, Eigen::Vector3d::UnitZ()));
  const LineCurve curve(middle, end);
  JointPiece scaled = piece;
  scaled.length = curve.length();
  ASSERT_LT((middle.translation() - curve.at(0.5 * curve.length()).p).norm(), 1e-9);
  ASSERT_LT((arm.pose(q0).translation() - middle.translation()).norm(), 1e-9);
  const Deviation truth = sampled(arm, scaled, curve, 0.0, 1000);
  ASSERT_GT(truth.position, 0.005);
  const Deviation bound = bound_deviation(arm, scaled, curve, 0.0, 1e-5, 1e-5);
  EXPECT_GE(bound.position, truth.position);
  EXPECT_LE(bound.position, truth.position + 2e-5);
  EXPECT_GE(bound.angle, truth.angle);
}

TEST(BoundDeviation, IsAboveWhatTheMidpointTestSeesOnLongLines) {
  const ForwardKinematics arm = testing::puma560();
  const JointLimits range = testing::puma560_limits();
  int lines = 0;
  int blind = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    const RandomLine line = random_line(arm, range, seed, 0.5);
    JointVector goal;
    try {
      goal = insert_curve(arm, testing::no_position_limits(6), line.curve, line.start, {})
                 .knots.back();
    } catch (const MotionError&) {
      continue;
    }
    ++lines;
    // Tolerances that the midpoint just holds: the test is content with the ends alone.
    const double length = line.curve.length();
    const Pose middle = arm.pose(0.5 * (line.start + goal));
    const CurvePoint wanted = line.curve.at(0.5 * length);
    const double position = 1.001 * (middle.translation() - wanted.p).norm();
    const double angle = 1.001 * rotation_distance(wanted.rotation, middle.linear());
    const TaylorKnots taylor = taylor_insertion(arm, line.curve, line.start, goal, position, angle);
    ASSERT_EQ(taylor.knots.size(), 2u);
    const JointPiece piece = JointPiece::line(line.start, goal, length);
    const Deviation bound = bound_deviation(arm, piece, line.curve, 0.0, 1e-5, 1e-4);
    ASSERT_GE(bound.position, taylor.at_midpoints.position);
    ASSERT_GE(bound.angle, taylor.at_midpoints.angle);
    if (bound.position > 1.1 * position || bound.angle > 1.1 * angle) ++blind;
  }
  ASSERT_GT(lines, 200);
  // Rare, which is why it goes unnoticed.
  EXPECT_GT(blind, 10);
}

}  // namespace
}  // namespace viapoint
