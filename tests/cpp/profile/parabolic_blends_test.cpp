#include "viapoint/profile/parabolic_blends.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <span>
#include <string>

#include "golden.hpp"
#include "problem_count.hpp"
#include "profile/law_checks.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

void expect_values(const std::vector<double>& values, const nlohmann::json& wanted) {
  ASSERT_EQ(values.size(), wanted.size());
  for (size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], wanted[i].get<double>(), 1e-11) << i;
  }
}

void expect_sound(const BlendedLines& lines, const std::vector<double>& points) {
  EXPECT_EQ(lines.law.at(0.0).q, points.front());
  EXPECT_EQ(lines.law.at(0.0).qd, 0.0);
  const AxisState end = lines.law.at(lines.law.end());
  double size = 0.0, speed = 0.0;
  for (const double q : points) size = std::max(size, std::abs(q));
  for (const double v : lines.linear_velocity) speed = std::max(speed, std::abs(v));
  EXPECT_NEAR(end.q, points.back(), 1e-10 * size);
  EXPECT_NEAR(end.qd, 0.0, 1e-10 * speed);
  EXPECT_NEAR(lines.law.end(), std::accumulate(lines.durations.begin(), lines.durations.end(), 0.0),
              1e-10 * lines.law.end());
  expect_continuous(lines.law, 1, 1e-9);
  for (const double t : lines.linear_time) EXPECT_GE(t, 0.0);
}

/// Lines at given speeds: durations first, then the law.
BlendedLines at_speed(std::span<const double> points, std::span<const double> speeds,
                      std::span<const double> accelerations) {
  return blended_lines(points, durations_at_speed(points, speeds, accelerations), accelerations);
}

TEST(BlendedLines, GoldenTextbookSection2) {
  const std::vector<double> points{10.0, 35.0, 25.0, 10.0};
  const auto wanted = golden("lfpb_10_35_25_10_durations_2_1_3_acc_50");
  const BlendedLines lines = blended_lines(points, std::array{2.0, 1.0, 3.0}, std::array{50.0});
  expect_values(lines.blend_acceleration, wanted.at("blend_acc"));
  expect_values(lines.blend_time, wanted.at("blend_time"));
  expect_values(lines.linear_velocity, wanted.at("linear_velocity"));
  expect_values(lines.linear_time, wanted.at("linear_time"));
  expect_sound(lines, points);
  EXPECT_NEAR(lines.law.extremes(2).high, 50.0, 1e-12);
  EXPECT_NEAR(lines.law.extremes(2).low, -50.0, 1e-12);
}

TEST(BlendedLines, LinesPointAtTheirViaPoints) {
  const std::vector<double> points{10.0, 35.0, 25.0, 10.0};
  const BlendedLines lines = blended_lines(points, std::array{2.0, 1.0, 3.0}, std::array{50.0});
  // The second line, prolonged, passes point 1 at 2 s and point 2 at 3 s.
  const AxisState middle = lines.law.at(2.5);
  EXPECT_NEAR(middle.q + (2.0 - 2.5) * middle.qd, 35.0, 1e-11);
  EXPECT_NEAR(middle.q + (3.0 - 2.5) * middle.qd, 25.0, 1e-11);
  // The via point itself is passed by at an eighth of Δv t_blend.
  EXPECT_NEAR(lines.law.at(2.0).q, 35.0 - 50.0 * std::pow(lines.blend_time[1], 2) / 8.0, 1e-11);
}

TEST(BlendedLines, TakesOneAccelerationAPoint) {
  const std::vector<double> points{0.0, 1.0, 0.0};
  const BlendedLines lines =
      blended_lines(points, std::array{1.0, 1.0}, std::array{20.0, 30.0, 40.0});
  EXPECT_EQ(lines.blend_acceleration[0], 20.0);
  EXPECT_EQ(lines.blend_acceleration[1], -30.0);
  EXPECT_EQ(lines.blend_acceleration[2], 40.0);
  expect_sound(lines, points);
}

TEST(BlendedLines, TwoPointsMakeASymmetricTrapezoid) {
  // a t (T − t) = Δq with T = 3, Δq = 2, a = 1: t = 1.
  const BlendedLines lines = blended_lines(std::array{0.0, 2.0}, std::array{3.0}, std::array{1.0});
  EXPECT_NEAR(lines.blend_time[0], 1.0, 1e-14);
  EXPECT_NEAR(lines.blend_time[1], 1.0, 1e-14);
  EXPECT_NEAR(lines.linear_velocity[0], 1.0, 1e-14);
  expect_sound(lines, {0.0, 2.0});
}

TEST(BlendedLines, RestsAtRepeatedPoints) {
  const std::vector<double> points{1.0, 1.0, 2.0, 2.0};
  const BlendedLines lines = blended_lines(points, std::array{1.0, 1.0, 1.0}, std::array{10.0});
  EXPECT_EQ(lines.blend_time[0], 0.0);
  EXPECT_EQ(lines.linear_velocity[0], 0.0);
  EXPECT_EQ(lines.law.at(0.5).q, 1.0);
  expect_sound(lines, points);
}

TEST(BlendedLines, NamesTheLeastAccelerationThatWorks) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-3.0, 3.0);
    std::vector<double> points{any(random)}, durations;
    const int segments = 1 + static_cast<int>(random() % 6);
    for (int i = 0; i < segments; ++i) {
      points.push_back(any(random));
      durations.push_back(std::exp(0.3 * any(random)));
    }
    double least = 0.0;
    try {
      static_cast<void>(blended_lines(points, durations, std::array{1e-6}));
      ADD_FAILURE() << "accepted";
    } catch (const MotionError& error) {
      ASSERT_TRUE(error.problem().limit.has_value());
      least = *error.problem().limit;
      EXPECT_NE(std::string(error.what()).find("at least"), std::string::npos);
    }
    expect_sound(blended_lines(points, durations, std::array{least}), points);
    EXPECT_THROW(static_cast<void>(blended_lines(points, durations, std::array{least * 0.999999})),
                 MotionError);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(BlendedLines, RunsItsLinesAtTheGivenSpeeds) {
  const std::vector<double> points{10.0, 35.0, 25.0, 10.0};
  const std::array speeds{20.0, 10.0, 5.0};
  const BlendedLines lines = at_speed(points, speeds, std::array{50.0});
  EXPECT_NEAR(lines.linear_velocity[0], 20.0, 1e-12);
  EXPECT_NEAR(lines.linear_velocity[1], -10.0, 1e-12);
  EXPECT_NEAR(lines.linear_velocity[2], -5.0, 1e-12);
  EXPECT_NEAR(lines.durations[1], 1.0, 1e-12);
  EXPECT_NEAR(lines.durations[0], 25.0 / 20.0 + 0.5 * 20.0 / 50.0, 1e-12);
  expect_sound(lines, points);
  const BlendedLines pair = at_speed(std::array{0.0, 2.0}, std::array{1.0}, std::array{1.0});
  EXPECT_NEAR(pair.durations[0], 3.0, 1e-12);
  EXPECT_NEAR(pair.linear_velocity[0], 1.0, 1e-12);
}

TEST(BlendedLines, NamesTheLargestSpeedItsEndsReach) {
  // Rest to rest over 2 at acceleration 1: bang-bang peaks at √2.
  const std::array two{0.0, 2.0};
  const std::array one{1.0};
  try {
    static_cast<void>(at_speed(two, std::array{1.5}, one));
    FAIL() << "accepted";
  } catch (const MotionError& error) {
    EXPECT_NEAR(error.problem().limit.value(), std::sqrt(2.0), 1e-14);
    EXPECT_NE(std::string(error.what()).find("1.414214"), std::string::npos) << error.what();
  }
  const BlendedLines lines = at_speed(two, std::array{1.41}, one);
  EXPECT_NEAR(lines.linear_velocity[0], 1.41, 1e-12);
}

TEST(BlendedLines, RefusesWhatDoesNotFit) {
  const std::array two{0.0, 1.0};
  const std::array one{1.0};
  EXPECT_THROW(static_cast<void>(blended_lines(one, {}, one)), MotionError);
  EXPECT_THROW(static_cast<void>(blended_lines(two, two, one)), MotionError);
  EXPECT_THROW(static_cast<void>(blended_lines(two, one, std::array{1.0, 1.0, 1.0})), MotionError);
  EXPECT_THROW(static_cast<void>(blended_lines(two, one, std::array{-5.0})), MotionError);
  EXPECT_THROW(static_cast<void>(blended_lines(two, std::array{0.0}, one)), MotionError);
  EXPECT_THROW(static_cast<void>(at_speed(std::array{1.0, 1.0}, one, one)), MotionError);
  EXPECT_THROW(static_cast<void>(at_speed(two, std::array{100.0}, one)), MotionError);
}

TEST(ParabolicBlend, FollowsItsFormInTheBlend) {
  const double w0 = 1.0, w1 = 3.0, w2 = 2.0, before = 2.0, after = 1.0, half = 0.4;
  const AxisLaw law = parabolic_blend(w0, w1, w2, before, after, half);
  const double a = (before * (w2 - w1) - after * (w1 - w0)) / (2.0 * before * after * half);
  const double b = (w1 - w0) / before, c = w1 - half / before * (w1 - w0);
  for (const double t : {1.6, 1.8, 2.0, 2.3, 2.39}) {
    const double tau = t - before + half;
    EXPECT_NEAR(law.at(t).q, 0.5 * a * tau * tau + b * tau + c, 1e-14);
  }
  expect_continuous(law, 1);
  EXPECT_EQ(law.at(0.0).q, w0);
  EXPECT_NEAR(law.at(3.0).q, w2, 1e-14);
  EXPECT_THROW(static_cast<void>(parabolic_blend(w0, w1, w2, before, after, 1.1)), MotionError);
  EXPECT_THROW(static_cast<void>(parabolic_blend(w0, w1, w2, before, after, 0.0)), MotionError);
}

}  // namespace
}  // namespace viapoint
