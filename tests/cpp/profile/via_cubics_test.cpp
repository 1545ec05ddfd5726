#include "viapoint/profile/via_cubics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "golden.hpp"
#include "problem_count.hpp"
#include "profile/law_checks.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

void expect_cubics(const AxisLaw& law, const nlohmann::json& wanted) {
  ASSERT_EQ(law.parts().size(), 2u);
  for (size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(law.parts()[0].c[k], wanted.at("first")[k].get<double>(), 1e-12) << "power " << k;
    EXPECT_NEAR(law.parts()[1].c[k], wanted.at("second")[k].get<double>(), 1e-12) << "power " << k;
  }
}

AxisLaw spline(std::span<const double> points, std::span<const double> durations) {
  return via_cubics(points, durations, spline_velocities(points, durations));
}

TEST(ViaCubics, GoldenTextbookSection2EqualDurations) {
  const AxisLaw law = spline(std::array{5.0, 15.0, 40.0}, std::array{1.0, 1.0});
  expect_cubics(law, golden("two_cubics_via_5_15_40_equal_1s"));
  expect_continuous(law, 2);
}

TEST(ViaCubics, GoldenTextbookSection2UnequalDurations) {
  const AxisLaw law = spline(std::array{5.0, 15.0, -10.0}, std::array{1.0, 2.0});
  expect_cubics(law, golden("two_cubics_via_5_15_-10_1s_2s"));
  expect_continuous(law, 2);
}

TEST(ViaCubics, SlopeHeuristicIsZeroAtReversalsAndTheMeanElsewhere) {
  const std::array points{0.0, 1.0, 3.0, 2.0, 2.0, 5.0};
  const std::array durations{1.0, 1.0, 0.5, 1.0, 1.0};
  const std::vector<double> velocities = slope_velocities(points, durations, 0.25, -0.25);
  const std::array wanted{0.25, 1.5, 0.0, 0.0, 0.0, -0.25};
  ASSERT_EQ(velocities.size(), wanted.size());
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_EQ(velocities[i], wanted[i]) << i;
  const AxisLaw law = via_cubics(points, durations, velocities);
  expect_continuous(law, 1);
  EXPECT_EQ(law.at(1.0).qd, 1.5);
  EXPECT_EQ(law.at(1.0).q, 1.0);
}

TEST(ViaCubics, SplineKeepsAccelerationContinuousOverManyPoints) {
  for (int seed = 0; seed < problems(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-3.0, 3.0);
    std::vector<double> points{any(random)}, durations;
    const int segments = 1 + static_cast<int>(random() % 20);
    for (int i = 0; i < segments; ++i) {
      points.push_back(any(random));
      durations.push_back(std::exp(0.5 * any(random)));
    }
    const double first = any(random), last = any(random);
    const AxisLaw law =
        via_cubics(points, durations, spline_velocities(points, durations, first, last));
    expect_continuous(law, 2, 1e-10);
    expect_extremes_hold(law);
    EXPECT_EQ(law.at(0.0).qd, first);
    EXPECT_NEAR(law.at(law.end()).qd, last, 1e-11);
    double t = 0.0;
    for (size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(law.at(t).q, points[i], 1e-11);
      if (i < durations.size()) t += durations[i];
    }
    if (testing::Test::HasFailure()) return;
  }
}

/// Random points and durations over more than a decade.
struct Way {
  std::vector<double> points, durations;

  explicit Way(int seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-3.0, 3.0);
    const int segments = 1 + static_cast<int>(random() % 12);
    points.push_back(any(random));
    for (int i = 0; i < segments; ++i) {
      points.push_back(any(random));
      durations.push_back(std::exp(0.5 * any(random)));
    }
  }
};

TEST(ViaCubics, NaturalSplineHasNoAccelerationAtItsEnds) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Way way(seed);
    const AxisLaw law =
        via_cubics(way.points, way.durations, natural_spline_velocities(way.points, way.durations));
    expect_continuous(law, 2, 1e-10);
    const Extremes acceleration = law.extremes(2);
    const double scale = std::max({-acceleration.low, acceleration.high, 1.0});
    EXPECT_NEAR(law.at(0.0).qdd, 0.0, 1e-11 * scale);
    EXPECT_NEAR(law.at(law.end()).qdd, 0.0, 1e-11 * scale);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(ViaCubics, PeriodicSplineCanBeRepeated) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Way way(seed);
    const AxisLaw law = via_cubics(way.points, way.durations,
                                   periodic_spline_velocities(way.points, way.durations));
    expect_continuous(law, 2, 1e-10);
    const Extremes speed = law.extremes(1), acceleration = law.extremes(2);
    const AxisState begin = law.at(0.0), end = law.at(law.end());
    EXPECT_NEAR(begin.qd, end.qd, 1e-11 * std::max(-speed.low, speed.high));
    EXPECT_NEAR(begin.qdd, end.qdd, 1e-10 * std::max({-acceleration.low, acceleration.high, 1.0}));
    if (testing::Test::HasFailure()) return;
  }
}

TEST(ViaCubics, AgreesWithTheFormOfKnotsAndVelocities) {
  // a = [T(v1+v0) − 2(w1−w0)]/T³, b = −[T(v1+2v0) − 3(w1−w0)]/T² (textbook §2).
  const double w0 = 0.3, w1 = -1.2, v0 = 0.8, v1 = 2.1, time = 0.7;
  const AxisLaw law = via_cubics(std::array{w0, w1}, std::array{time}, std::array{v0, v1});
  const auto& c = law.parts()[0].c;
  EXPECT_NEAR(c[3], (time * (v1 + v0) - 2.0 * (w1 - w0)) / (time * time * time), 1e-12);
  EXPECT_NEAR(c[2], -(time * (v1 + 2.0 * v0) - 3.0 * (w1 - w0)) / (time * time), 1e-12);
}

TEST(ViaCubics, RefusesSizesThatDoNotFit) {
  const std::array two{0.0, 1.0};
  const std::array one{1.0};
  EXPECT_THROW(static_cast<void>(via_cubics(one, {}, one)), MotionError);
  EXPECT_THROW(static_cast<void>(via_cubics(two, two, two)), MotionError);
  EXPECT_THROW(static_cast<void>(via_cubics(two, one, one)), MotionError);
  EXPECT_THROW(static_cast<void>(via_cubics(two, std::array{0.0}, two)), MotionError);
  EXPECT_THROW(static_cast<void>(slope_velocities(two, two)), MotionError);
  EXPECT_THROW(static_cast<void>(spline_velocities(two, std::array{-1.0})), MotionError);
}

}  // namespace
}  // namespace viapoint
