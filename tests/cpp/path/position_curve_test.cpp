#include "viapoint/path/position_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "path/random_curves.hpp"
#include "problem_count.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

using Eigen::Vector3d;
using testing::random_vector;

TEST(HelixCurve, PassesThroughItsThreePointsInOrder) {
  for (unsigned seed = 0; seed < problems(3000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const double size = std::pow(10.0, -3.0 + 4.0 * (seed % 10) / 10.0);
    const Vector3d start = random_vector(random, size);
    const Vector3d via = random_vector(random, size);
    const Vector3d end = random_vector(random, size);
    const HelixCurve arc = HelixCurve::through(start, via, end);
    const double rounding = 1e-13 * (arc.radius() + arc.center().norm()) + 1e-15;
    ASSERT_LT((arc.at(0.0).p - start).norm(), rounding);
    ASSERT_LT((arc.at(arc.length()).p - end).norm(), 1e3 * rounding);
    const double share = arc.share_at(via);
    ASSERT_GT(share, 0.0);
    ASSERT_LT(share, 1.0);
    ASSERT_LT((arc.at(share * arc.length()).p - via).norm(), 1e3 * rounding);
    ASSERT_GT(arc.angle(), 0.0);
    ASSERT_LT(arc.angle(), 2.0 * kPi);
    // All of it is on one circle, and s is the length.
    for (int i = 0; i <= 10; ++i) {
      const PositionPoint point = arc.at(arc.length() * i / 10);
      ASSERT_NEAR((point.p - arc.center()).norm(), arc.radius(), 1e-12 * arc.radius() + 1e-15);
      ASSERT_NEAR(point.p1.norm(), 1.0, 1e-12);
    }
  }
}

TEST(HelixCurve, TurnsAboutItsAxisAsFarAsAsked) {
  const Vector3d start(0.5, 0.1, 0.3);
  const Vector3d center(0.4, 0.1, 0.0);
  for (const double angle : {0.1, -0.1, kPi, -3.0 * kPi, 2.0 * kPi, 25.0}) {
    SCOPED_TRACE(angle);
    const HelixCurve curve(start, center, Vector3d(0, 0, 5), angle, 0.01);
    const Vector3d end = curve.at(curve.length()).p;
    EXPECT_NEAR(end.x(), 0.4 + 0.1 * std::cos(angle), 1e-14);
    EXPECT_NEAR(end.y(), 0.1 + 0.1 * std::sin(angle), 1e-14);
    EXPECT_NEAR(end.z(), 0.3 + 0.01 * angle / (2.0 * kPi), 1e-14);
    EXPECT_NEAR(curve.length(), std::abs(angle) * std::hypot(0.1, 0.01 / (2.0 * kPi)), 1e-14);
    EXPECT_NEAR(curve.radius(), 0.1, 1e-15);
  }
}

TEST(HelixCurve, OnItsAxisIsALineOrATurnOnTheSpot) {
  const Vector3d start(0.5, 0.1, 0.3);
  const HelixCurve screw(start, start, Vector3d::UnitZ(), 4.0 * kPi, 0.002);
  EXPECT_NEAR(screw.length(), 0.004, 1e-15);
  EXPECT_LT((screw.at(screw.length()).p - (start + Vector3d(0, 0, 0.004))).norm(), 1e-15);
  const HelixCurve spot(start, start, Vector3d::UnitZ(), -1.5);
  EXPECT_NEAR(spot.length(), 1.5, 1e-15);
  EXPECT_LT((spot.at(1.0).p - start).norm(), 1e-15);
  const HelixCurve nothing(start, start, Vector3d::UnitZ(), 0.0);
  EXPECT_EQ(nothing.length(), 0.0);
  EXPECT_TRUE(nothing.at(0.0).p.allFinite());
}

ErrorCode refusal(const Vector3d& start, const Vector3d& via, const Vector3d& end) {
  try {
    (void)HelixCurve::through(start, via, end);
  } catch (const MotionError& error) {
    EXPECT_FALSE(error.problem().ways_out.empty());
    return error.code();
  }
  return ErrorCode::kInternal;
}

TEST(HelixCurve, RefusesPointsThatDefineNoCircle) {
  const Vector3d a(0.1, 0.2, 0.3);
  const Vector3d b(0.4, 0.2, 0.3);
  const Vector3d c(0.2, 0.5, 0.3);
  EXPECT_EQ(refusal(a, a, b), ErrorCode::kDegenerateCurve);
  EXPECT_EQ(refusal(a, b, b), ErrorCode::kDegenerateCurve);
  EXPECT_EQ(refusal(a, b, a), ErrorCode::kDegenerateCurve);
  EXPECT_EQ(refusal(a, b, a + Vector3d(5e-7, 0, 0)), ErrorCode::kDegenerateCurve);
  EXPECT_EQ(refusal(a, 0.5 * (a + b), b), ErrorCode::kDegenerateCurve);
  EXPECT_EQ(refusal(a, b, 0.5 * (a + b)), ErrorCode::kDegenerateCurve);
  EXPECT_EQ(refusal(a, 0.5 * (a + b) + Vector3d(0, 1e-8, 0), b), ErrorCode::kDegenerateCurve);
  EXPECT_EQ(refusal(a, c, b), ErrorCode::kInternal);
  EXPECT_EQ(refusal(a, 0.5 * (a + b) + Vector3d(0, 1e-5, 0), b), ErrorCode::kInternal);
  EXPECT_THROW(HelixCurve(a, b, Vector3d::Zero(), 1.0), MotionError);
  EXPECT_THROW(HelixCurve(a, b, Vector3d::UnitX(), std::nan("")), MotionError);
}

TEST(SplineCurve, TellsWhereItsThirdDerivativeJumps) {
  const std::vector<double> at = {0.0, 1.0, 2.5, 3.0};
  std::mt19937 random(4);
  std::vector<JointVector> points;
  for (size_t k = 0; k < at.size(); ++k) points.emplace_back(random_vector(random, 1.0));
  const SplineCurve curve(quintic_chain(natural_spline(points, at, 3), at));
  EXPECT_EQ(curve.last_break(0.2, 0.7), 0.7);
  EXPECT_EQ(curve.last_break(0.2, 1.7), 1.0);
  EXPECT_EQ(curve.last_break(0.2, 2.8), 2.5);
  EXPECT_EQ(curve.last_break(0.2, 3.0), 2.5);
  EXPECT_EQ(curve.last_break(0.2, 1.0), 1.0);
  EXPECT_EQ(curve.last_break(1.0, 2.5), 2.5);
}

}  // namespace
}  // namespace viapoint
