#include "viapoint/path/orientation_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "path/random_curves.hpp"
#include "problem_count.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/path/spline.hpp"

namespace viapoint {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::random_rotation;
using testing::random_vector;

struct Turns {
  std::vector<Matrix3d> rotations;
  std::vector<double> at;
};

/// Rotations up to `most` rad apart.
Turns random_turns(unsigned seed, size_t count, double most) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.05, 1.0);
  Turns turns{{random_rotation(random)}, {0.0}};
  while (turns.at.size() < count) {
    const Vector3d turn = random_vector(random, 1.0).normalized() * most * unit(random);
    turns.rotations.emplace_back(rotation_exp(turn) * turns.rotations.back());
    turns.at.push_back(turns.at.back() + unit(random));
  }
  return turns;
}

TEST(OrientationSpline, PassesItsOrientationsWithContinuousRates) {
  for (unsigned seed = 0; seed < problems(1000U); ++seed) {
    SCOPED_TRACE(seed);
    const Turns turns = random_turns(seed, 2 + seed % 8, 2.5);
    const OrientationSpline spline = OrientationSpline::through(turns.rotations, turns.at);
    for (size_t k = 0; k < turns.at.size(); ++k) {
      const double s = turns.at[k];
      ASSERT_LT(rotation_distance(spline.at(s).rotation, turns.rotations[k]), 1e-12);
      if (k == 0 || k + 1 == turns.at.size()) continue;
      const OrientationPoint before = spline.at(std::nextafter(s, 0.0));
      const OrientationPoint after = spline.at(s);
      ASSERT_LT(rotation_distance(before.rotation, after.rotation), 1e-11);
      ASSERT_LT((before.w - after.w).norm(), 1e-10 * (1.0 + after.w.norm()));
      ASSERT_LT((before.w1 - after.w1).norm(), 1e-8 * (1.0 + after.w1.norm()));
    }
  }
}

TEST(OrientationSpline, AboutOneAxisIsTheSplineOfTheAngle) {
  const Vector3d axis = Vector3d(1.0, 2.0, -2.0) / 3.0;
  const std::vector<double> at = {0.0, 0.5, 1.2, 2.0, 2.3};
  const std::vector<double> angles = {0.0, 1.0, 3.5, 2.0, 2.5};
  std::mt19937 random(2);
  const Matrix3d base = random_rotation(random);
  std::vector<Matrix3d> rotations;
  std::vector<JointVector> points;
  for (const double angle : angles) {
    rotations.emplace_back(rotation_exp(angle * axis) * base);
    points.push_back(JointVector::Constant(1, angle));
  }
  const OrientationSpline spline = OrientationSpline::through(rotations, at);
  const JointPath angle = quintic_chain(natural_spline(points, at, 3), at);
  for (int i = 0; i <= 230; ++i) {
    const double s = 0.01 * i;
    const OrientationPoint point = spline.at(s);
    const PathPoint wanted = angle.at(s);
    ASSERT_LT(rotation_distance(point.rotation, rotation_exp(wanted.q[0] * axis) * base), 1e-12);
    ASSERT_LT((point.w - wanted.q1[0] * axis).norm(), 1e-11);
    ASSERT_LT((point.w1 - wanted.q2[0] * axis).norm(), 1e-10);
  }
}

TEST(OrientationSpline, DoesNotDependOnTheFrameItIsSeenFrom) {
  const Turns turns = random_turns(11, 6, 1.5);
  std::mt19937 random(3);
  const Matrix3d frame = random_rotation(random);
  const Matrix3d tool = random_rotation(random);
  std::vector<Matrix3d> seen;
  for (const Matrix3d& rotation : turns.rotations) seen.emplace_back(frame * rotation * tool);
  const OrientationSpline here = OrientationSpline::through(turns.rotations, turns.at);
  const OrientationSpline there = OrientationSpline::through(seen, turns.at);
  for (int i = 0; i <= 100; ++i) {
    const double s = turns.at.back() * i / 100;
    ASSERT_LT(rotation_distance(frame * here.at(s).rotation * tool, there.at(s).rotation), 1e-12);
  }
}

TEST(OrientationSpline, MeetsKnotsWhateverTheirRates) {
  for (unsigned seed = 0; seed < problems(500U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::vector<OrientationKnot> knots;
    for (int k = 0; k < 4; ++k) {
      knots.push_back({0.7 * k, random_rotation(random), random_vector(random, 2.0),
                       random_vector(random, 5.0)});
    }
    const OrientationSpline spline(knots);
    for (const OrientationKnot& knot : knots) {
      for (const double s : {std::nextafter(knot.s, 0.0), knot.s}) {
        const OrientationPoint point = spline.at(std::max(s, 0.0));
        ASSERT_LT(rotation_distance(point.rotation, knot.rotation), 1e-11);
        ASSERT_LT((point.w - knot.w).norm(), 1e-9);
        ASSERT_LT((point.w1 - knot.w1).norm(), 1e-7 * (1.0 + point.w2.norm()));
      }
    }
  }
}

TEST(OrientationSpline, RefusesAHalfTurnByItsNumber) {
  const Matrix3d here = Matrix3d::Identity();
  const Matrix3d there = rotation_exp(kPi * Vector3d::UnitX());
  try {
    (void)OrientationSpline::through(std::vector<Matrix3d>{here, here, there},
                                     std::vector<double>{0.0, 1.0, 2.0});
    FAIL() << "a half turn passed";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kHalfTurn);
    EXPECT_NE(error.problem().message.find("1 and 2"), std::string::npos);
  }
}

TEST(ExponentialPoint, BoundsOfItsRatesHold) {
  // ‖w'‖ <= ‖φ''‖ + ½‖φ'‖² and ‖w''‖ <= ‖φ'''‖ + 3/2 ‖φ'‖‖φ''‖ + ½‖φ'‖³, also far from zero.
  double tightest1 = 0.0;
  double tightest2 = 0.0;
  for (unsigned seed = 0; seed < problems(20000U); ++seed) {
    std::mt19937 random(seed);
    const Vector3d v = random_vector(random, 1.5);
    const Vector3d v1 = random_vector(random, 1.0);
    const Vector3d v2 = random_vector(random, seed % 3 == 0 ? 0.01 : 1.0);
    const Vector3d v3 = random_vector(random, seed % 2 == 0 ? 0.01 : 1.0);
    const OrientationPoint point = exponential_point(v, v1, v2, v3, Matrix3d::Identity());
    const double first = v1.norm();
    const double second = v2.norm();
    const double bound1 = second + 0.5 * first * first;
    const double bound2 = v3.norm() + 1.5 * first * second + 0.5 * first * first * first;
    ASSERT_LE(point.w.norm(), first * (1 + 1e-12)) << seed;
    ASSERT_LE(point.w1.norm(), bound1 * (1 + 1e-12)) << seed;
    ASSERT_LE(point.w2.norm(), bound2 * (1 + 1e-12)) << seed;
    tightest1 = std::max(tightest1, point.w1.norm() / bound1);
    tightest2 = std::max(tightest2, point.w2.norm() / bound2);
  }
  EXPECT_GT(tightest1, 0.9);
  EXPECT_GT(tightest2, 0.7);
}

TEST(SteadyTurn, ReachesTheOtherOrientationByTheLeastRotation) {
  for (unsigned seed = 0; seed < problems(500U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Matrix3d from = random_rotation(random);
    const Matrix3d to = random_rotation(random);
    const SteadyTurn turn = SteadyTurn::between(from, to, 0.4);
    ASSERT_LT(rotation_distance(turn.at(0.4).rotation, to), 1e-12);
    ASSERT_NEAR(turn.at(0.1).w.norm() * 0.4, rotation_distance(from, to), 1e-12);
  }
}

}  // namespace
}  // namespace viapoint
