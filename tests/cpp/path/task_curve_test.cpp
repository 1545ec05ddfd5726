#include "viapoint/path/task_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "problem_count.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(normal(random), normal(random), normal(random));
  pose.linear() = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                      .normalized()
                      .toRotationMatrix();
  return pose;
}

TEST(LineCurve, RunsFromStartToGoalByTheLeastRotation) {
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Pose from = random_pose(random);
    const Pose to = random_pose(random);
    const LineCurve curve(from, to);
    ASSERT_NEAR(curve.length(), (to.translation() - from.translation()).norm(), 1e-15);
    const CurvePoint start = curve.at(0.0);
    const CurvePoint end = curve.at(curve.length());
    ASSERT_LT((start.p - from.translation()).norm(), 1e-15);
    ASSERT_LT((end.p - to.translation()).norm(), 1e-14);
    ASSERT_LT(rotation_distance(start.rotation, from.linear()), 1e-15);
    ASSERT_LT(rotation_distance(end.rotation, to.linear()), 1e-13);
    // The angle swept is the angle between the ends: no longer way round.
    ASSERT_NEAR(start.w.norm() * curve.length(), rotation_distance(from.linear(), to.linear()),
                1e-12);
  }
}

TEST(LineCurve, DerivativesAgreeWithDifferences) {
  for (unsigned seed = 0; seed < problems(500U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const LineCurve curve(random_pose(random), random_pose(random));
    constexpr double kStep = 1e-5;
    const double s = 0.3 * curve.length();
    const CurvePoint before = curve.at(s - kStep);
    const CurvePoint here = curve.at(s);
    const CurvePoint after = curve.at(s + kStep);
    ASSERT_LT(((after.p - before.p) / (2 * kStep) - here.p1).norm(), 1e-9);
    // The spatial rate: R(s + h) = exp(w h) R(s).
    const Eigen::Vector3d w =
        rotation_log(after.rotation * before.rotation.transpose()) / (2 * kStep);
    ASSERT_LT((w - here.w).norm(), 1e-8);
    ASSERT_EQ(here.p2.norm() + here.p3.norm() + here.w1.norm() + here.w2.norm(), 0.0);
    const CurveBounds bounds = curve.bounds(0.0, curve.length());
    ASSERT_GE(bounds.w, here.w.norm());
  }
}

TEST(LineCurve, CountsTheAngleWhenItTurnsOnTheSpot) {
  Pose from = Pose::Identity();
  from.translation() = Eigen::Vector3d(0.3, 0.2, 0.1);
  Pose to = from;
  to.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 2.0).normalized()));
  const LineCurve curve(from, to);
  EXPECT_NEAR(curve.length(), 0.7, 1e-15);
  EXPECT_NEAR(curve.at(0.2).w.norm(), 1.0, 1e-15);
  EXPECT_EQ(curve.at(0.2).p1.norm(), 0.0);
}

TEST(LineCurve, TravelsAsFarInMetresWhateverItsParameterCounts) {
  // A turn of 1 rad with a travel about the 1 nm where s becomes the angle.
  Pose from = Pose::Identity();
  from.translation() = Eigen::Vector3d(0.3, 0.2, 0.1);
  for (const double travel : {0.0, 1e-10, 0.9e-9, 1.1e-9, 1e-8, 1e-6, 0.1}) {
    SCOPED_TRACE(travel);
    Pose to = from;
    to.translation().x() += travel;
    to.rotate(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));
    const LineCurve curve(from, to);
    const CurvePoint middle = curve.at(0.5 * curve.length());
    EXPECT_NEAR(middle.p1.norm() * curve.length(), travel, 1e-15);
    EXPECT_NEAR(middle.w.norm() * curve.length(), 1.0, 1e-12);
    EXPECT_NEAR(rotation_distance(from.linear(), middle.rotation), 0.5, 1e-12);
  }
}

TEST(LineCurve, FixedOrientationKeepsTheStartingOne) {
  std::mt19937 random(3);
  const Pose from = random_pose(random);
  const LineCurve curve = LineCurve::fixed_orientation(from, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_LT(rotation_distance(curve.at(curve.length()).rotation, from.linear()), 1e-15);
  EXPECT_LT(curve.at(0.0).w.norm(), 1e-15);
}

TEST(LineCurve, TellsAHalfTurn) {
  const Pose from = Pose::Identity();
  const auto turned = [](double angle) {
    Pose to = Pose::Identity();
    to.translation() = Eigen::Vector3d(0.1, 0.0, 0.0);
    to.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d(0.6, 0.0, 0.8)));
    return to;
  };
  EXPECT_TRUE(LineCurve(from, turned(kPi)).half_turn());
  EXPECT_TRUE(LineCurve(from, turned(kPi - 1e-10)).half_turn());
  EXPECT_FALSE(LineCurve(from, turned(kPi - 1e-8)).half_turn());
  EXPECT_FALSE(LineCurve(from, turned(1.0)).half_turn());
}

TEST(LineCurve, HasNoLengthWhereItGoesNowhere) {
  const Pose pose = Pose::Identity();
  const LineCurve curve(pose, pose);
  EXPECT_EQ(curve.length(), 0.0);
  EXPECT_TRUE(curve.at(0.0).p.allFinite());
}

}  // namespace
}  // namespace viapoint
