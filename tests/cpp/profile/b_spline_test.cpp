#include "viapoint/profile/b_spline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "problem_count.hpp"
#include "profile/law_checks.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/profile/via_cubics.hpp"

namespace viapoint {
namespace {

/// De Casteljau's point at u.
double casteljau(std::vector<double> points, double u) {
  for (size_t n = points.size() - 1; n > 0; --n) {
    for (size_t i = 0; i < n; ++i) points[i] = (1 - u) * points[i] + u * points[i + 1];
  }
  return points[0];
}

std::vector<double> random_points(std::mt19937_64& random, size_t size) {
  std::uniform_real_distribution<double> any(-3.0, 3.0);
  std::vector<double> points;
  for (size_t i = 0; i < size; ++i) points.push_back(any(random));
  return points;
}

TEST(Bezier, AgreesWithDeCasteljauAtEveryDegree) {
  for (int seed = 0; seed < problems(1000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const std::vector<double> points = random_points(random, 2 + random() % 11);
    const double t0 = 1.5, time = 0.7;
    const AxisLaw law = bezier(points, t0, t0 + time);
    for (int i = 0; i <= 20; ++i) {
      EXPECT_NEAR(law.at(t0 + time * i / 20).q, casteljau(points, i / 20.0), 1e-10);
    }
    const double degree = static_cast<double>(points.size() - 1);
    EXPECT_NEAR(law.at(t0).qd, degree * (points[1] - points[0]) / time, 1e-12 * degree);
    const auto [low, high] = std::ranges::minmax(points);
    EXPECT_GE(law.extremes(0).low, low - 1e-10);
    EXPECT_LE(law.extremes(0).high, high + 1e-10);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(BSpline, WithoutInnerKnotsIsABezier) {
  const std::vector<double> points{0.3, 1.4, -0.6, 0.9};
  const AxisLaw spline = b_spline(points, clamped_knots(4, 3, 2.0, 3.5), 3);
  const AxisLaw curve = bezier(points, 2.0, 3.5);
  for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(spline.parts()[0].c[k], curve.parts()[0].c[k], 1e-13);
}

TEST(BSpline, IsAsSmoothAsItsDegreeAndStaysInItsHull) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const int degree = 1 + static_cast<int>(random() % 5);
    const size_t size = static_cast<size_t>(degree) + 1 + random() % 8;
    const std::vector<double> points = random_points(random, size);
    std::vector<double> knots = clamped_knots(size, degree, 1.0, 4.0);
    std::uniform_real_distribution<double> nudge(0.2, 1.0);
    double t = 1.0;  // spans of unequal length
    for (size_t i = static_cast<size_t>(degree) + 1; i < size; ++i) knots[i] = t += nudge(random);
    for (size_t i = size; i < knots.size(); ++i) knots[i] = t + 0.5;
    const AxisLaw law = b_spline(points, knots, degree);
    expect_continuous(law, std::min(degree - 1, 3), 1e-10);
    expect_extremes_hold(law);
    EXPECT_EQ(law.at(law.start()).q, points.front());
    EXPECT_NEAR(law.at(law.end()).q, points.back(), 1e-11);
    const auto [low, high] = std::ranges::minmax(points);
    EXPECT_GE(law.extremes(0).low, low - 1e-11);
    EXPECT_LE(law.extremes(0).high, high + 1e-11);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(BSpline, ARepeatedKnotCostsContinuity) {
  const std::vector<double> points{0.0, 1.0, -1.0, 2.0, 0.5, 1.0};
  const std::array knots{0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0};
  const AxisLaw law = b_spline(points, knots, 3);
  expect_continuous(law, 1);
  EXPECT_GT(std::abs(law.parts()[0].at(1.0).qdd - law.parts()[1].at(1.0).qdd), 1.0);
}

TEST(BSpline, RefusesWhatDoesNotFit) {
  const std::vector<double> points{0.0, 1.0, -1.0, 2.0};
  const auto refused = [&](std::vector<double> knots, int degree) {
    EXPECT_THROW(static_cast<void>(b_spline(points, knots, degree)), MotionError);
  };
  refused({0, 0, 0, 0, 1, 1, 1, 1}, 0);
  refused({0, 0, 0, 0, 1, 1, 1, 1}, 6);
  refused({0, 0, 0, 0, 1, 1, 1}, 3);
  refused({0, 0, 0, 1, 0, 1, 1, 1}, 3);
  refused({0, 0, 0, 0, 0, 0, 0, 0}, 3);
  refused({0, 0, 1, 1, 2, 2}, 1);  // the inner knot twice in degree 1: a jump
  EXPECT_THROW(static_cast<void>(clamped_knots(3, 3, 0, 1)), MotionError);
  EXPECT_THROW(static_cast<void>(clamped_knots(4, 3, 1, 1)), MotionError);
  EXPECT_THROW(static_cast<void>(bezier(std::array{1.0}, 0, 1)), MotionError);
  EXPECT_THROW(static_cast<void>(bezier(std::vector<double>(13, 0.0), 0, 1)), MotionError);
}

TEST(SplineThrough, ReachesPointsAndEndConditions) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-3.0, 3.0);
    const size_t size = 2 + random() % 12;
    const std::vector<double> points = random_points(random, size);
    std::vector<double> durations;
    for (size_t i = 1; i < size; ++i) durations.push_back(std::exp(0.3 * any(random)));
    const AxisState first{0, any(random), any(random), 0}, last{0, any(random), any(random), 0};
    for (const int degree : {3, 5}) {
      SCOPED_TRACE("degree " + std::to_string(degree));
      const InterpolatingSpline spline = spline_through(points, durations, degree, first, last);
      const AxisLaw law = b_spline(spline.control_points, spline.knots, degree);
      expect_continuous(law, degree == 3 ? 2 : 3, 1e-9);
      double t = 0.0;
      for (size_t i = 0; i < size; ++i) {
        EXPECT_NEAR(law.at(t).q, points[i], 1e-10);
        if (i < durations.size()) t += durations[i];
      }
      EXPECT_NEAR(law.at(0.0).qd, first.qd, 1e-9);
      EXPECT_NEAR(law.at(law.end()).qd, last.qd, 1e-9);
      if (degree == 5) {
        EXPECT_NEAR(law.at(0.0).qdd, first.qdd, 1e-8);
        EXPECT_NEAR(law.at(law.end()).qdd, last.qdd, 1e-8);
      }
    }
    const InterpolatingSpline spline = spline_through(points, durations, 3, first, last);
    const AxisLaw law = b_spline(spline.control_points, spline.knots, 3);
    const std::vector<double> velocities = spline_velocities(points, durations, first.qd, last.qd);
    double t = 0.0;
    for (size_t i = 0; i < size; ++i) {
      EXPECT_NEAR(law.at(t).qd, velocities[i], 1e-9) << "not the spline of via_cubics()";
      if (i < durations.size()) t += durations[i];
    }
    if (testing::Test::HasFailure()) return;
  }
}

TEST(SplineThrough, RefusesWhatDoesNotFit) {
  const std::array points{0.0, 1.0, 0.5};
  EXPECT_THROW(static_cast<void>(spline_through(points, std::array{1.0, 1.0}, 4, {}, {})),
               MotionError);
  EXPECT_THROW(static_cast<void>(spline_through(points, std::array{1.0}, 3, {}, {})), MotionError);
  EXPECT_THROW(static_cast<void>(spline_through(points, std::array{1.0, 0.0}, 3, {}, {})),
               MotionError);
}

}  // namespace
}  // namespace viapoint
