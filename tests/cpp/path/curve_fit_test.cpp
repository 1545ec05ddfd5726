#include "viapoint/path/curve_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "path/random_curves.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

using Eigen::Vector3d;

/// A knot in space whose tool turns with it.
Pose knot(double t) {
  Pose pose = Pose::Identity();
  pose.translation() = 0.1 * Vector3d(std::sin(t) + 2.0 * std::sin(2.0 * t),
                                      std::cos(t) - 2.0 * std::cos(2.0 * t), -std::sin(3.0 * t));
  pose.linear() = rotation_exp({0.3 * std::sin(t), 0.2 * t, 0.1});
  return pose;
}

/// The fit, evaluated as the planner does.
std::unique_ptr<TaskCurve> curve_of(const CurveFit& fit) {
  std::vector<double> at;
  std::vector<Eigen::Matrix3d> rotations;
  for (size_t k = 0; k < fit.at.size(); ++k) {
    at.push_back(fit.at[k] - fit.at[0]);
    rotations.emplace_back(fit.poses[k].linear());
  }
  return std::make_unique<ToolCurve>(
      std::make_unique<SplineCurve>(
          quintic_chain(natural_spline(testing::positions_of(fit.poses), at, 3), at)),
      std::make_unique<OrientationSpline>(OrientationSpline::through(rotations, at)));
}

TEST(FitCurve, StaysWithinTheToleranceBetweenThePlacesItLookedAt) {
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6}) {
    SCOPED_TRACE(tolerance);
    const CurveFit fit = fit_curve(knot, 0.5, 0.5 + 2.0 * kPi, {tolerance, 1e-3});
    EXPECT_LE(fit.deviation.position, tolerance);
    EXPECT_LE(fit.deviation.angle, 1e-3);
    EXPECT_EQ(fit.looked_at, 8 * (fit.at.size() - 1));
    const auto curve = curve_of(fit);
    double worst = 0.0;
    for (int i = 0; i <= 20000; ++i) {
      const double s = 2.0 * kPi * i / 20000;
      worst = std::max(worst, (curve->at(s).p - knot(0.5 + s).translation()).norm());
    }
    // A smooth curve does no more between eight places than a little.
    EXPECT_LE(worst, 1.05 * tolerance);
    EXPECT_GE(worst, fit.deviation.position * (1 - 1e-9));
  }
}

TEST(FitCurve, TakesFewPosesForALineAndManyForABend) {
  const auto line = [](double t) {
    Pose pose = Pose::Identity();
    pose.translation() = t * Vector3d(0.1, 0.2, 0.3);
    return pose;
  };
  EXPECT_EQ(fit_curve(line, 0.0, 1.0, {1e-9, 1e-9}).at.size(), 9u);
  const size_t coarse = fit_curve(knot, 0.0, 6.0, {1e-3, 1e-1}).at.size();
  const size_t fine = fit_curve(knot, 0.0, 6.0, {1e-6, 1e-1}).at.size();
  EXPECT_GT(fine, 2 * coarse);
  EXPECT_LT(fine, 500u);
}

TEST(FitCurve, LeavesOutSamplesThatItDoesNotNeed) {
  std::vector<Pose> samples;
  std::vector<double> at;
  for (int i = 0; i <= 3000; ++i) {
    at.push_back(2.0 * kPi * i / 3000);
    samples.push_back(knot(at.back()));
  }
  const CurveFit fit = fit_curve(samples, at, {1e-4, 1e-3});
  EXPECT_LE(fit.deviation.position, 1e-4);
  EXPECT_LT(fit.at.size(), 200u);
  EXPECT_EQ(fit.at.front(), at.front());
  EXPECT_EQ(fit.at.back(), at.back());
  const auto curve = curve_of(fit);
  for (size_t i = 0; i < at.size(); ++i) {
    ASSERT_LE((curve->at(at[i]).p - samples[i].translation()).norm(), 1e-4 * (1 + 1e-9));
  }
}

TEST(FitCurve, PassesEverySampleOfAJaggedLineIfItMust) {
  std::mt19937 random(3);
  std::vector<Pose> samples;
  std::vector<double> at;
  for (int i = 0; i <= 50; ++i) {
    Pose pose = Pose::Identity();
    pose.translation() = testing::random_vector(random, 0.1);
    samples.push_back(pose);
    at.push_back(i);
  }
  const CurveFit fit = fit_curve(samples, at, {1e-6, 1e-3});
  EXPECT_EQ(fit.at.size(), samples.size());
  EXPECT_LT(fit.deviation.position, 1e-6);
}

TEST(FitCurve, NamesTheJumpThatNoSplineFollows) {
  const auto jump = [](double t) {
    Pose pose = Pose::Identity();
    pose.translation() = Vector3d(t, t > 0.3 ? 0.01 : 0.0, 0.0);
    return pose;
  };
  try {
    (void)fit_curve(jump, 0.0, 1.0, {1e-4, 1e-3});
    FAIL() << "a jump was fitted";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kDegenerateCurve);
    EXPECT_NEAR(*error.problem().share, 0.3, 1e-4);
  }
}

TEST(FitCurve, FollowsTurnsOfMoreThanHalfARound) {
  const auto spin = [](double t) {
    Pose pose = Pose::Identity();
    pose.translation() = Vector3d(t, 0.0, 0.0);
    pose.linear() = rotation_exp({0.0, 0.0, 40.0 * t});
    return pose;
  };
  const CurveFit fit = fit_curve(spin, 0.0, 1.0, {1e-4, 1e-3});
  const auto curve = curve_of(fit);
  for (int i = 0; i <= 1000; ++i) {
    const double s = i / 1000.0;
    ASSERT_LT(rotation_distance(curve->at(s).rotation, spin(s).linear()), 1.1e-3);
  }
}

TEST(FitCurve, RefusesArgumentsThatMakeNoSense) {
  const auto code = [](const auto& call) {
    try {
      call();
    } catch (const MotionError& error) {
      return error.code();
    }
    return ErrorCode::kInternal;
  };
  const std::vector<Pose> two(2, Pose::Identity());
  const std::vector<double> same = {1.0, 1.0};
  const std::vector<double> one = {1.0};
  EXPECT_EQ(code([&] { (void)fit_curve(two, same, {1e-3, 1e-3}); }), ErrorCode::kBadArgument);
  EXPECT_EQ(code([&] { (void)fit_curve(two, one, {1e-3, 1e-3}); }), ErrorCode::kBadArgument);
  EXPECT_EQ(code([&] { (void)fit_curve(knot, 1.0, 1.0, {1e-3, 1e-3}); }), ErrorCode::kBadArgument);
  EXPECT_EQ(code([&] { (void)fit_curve(knot, 0.0, 1.0, {0.0, 1e-3}); }), ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace viapoint
