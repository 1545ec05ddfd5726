#include "viapoint/profile/pseudo_via_points.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "problem_count.hpp"
#include "profile/law_checks.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/profile/parabolic_blends.hpp"

namespace viapoint {
namespace {

TEST(PseudoViaPoints, StandOnALineThroughThePoint) {
  const PseudoViaPoints pseudo = pseudo_via_points(std::array{0.0, 1.0, 3.0}, std::array{2.0, 1.0},
                                                   std::array{ThroughPoint{1, 0.5, 0.2}});
  EXPECT_EQ(pseudo.points, (std::vector{0.0, 0.9, 1.1, 3.0}));
  EXPECT_EQ(pseudo.durations, (std::vector{1.8, 0.4, 0.8}));
  EXPECT_EQ(pseudo.source, (std::vector<size_t>{0, 1, 1, 2}));
  EXPECT_EQ(pseudo.middles, (std::vector<size_t>{1}));
}

TEST(PseudoViaPoints, TakeTheMotionThroughAtTheWantedVelocity) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-3.0, 3.0), seconds(0.5, 2.0), share(0.1, 0.4);
    std::vector<double> points{any(random)}, durations;
    const size_t segments = 2 + random() % 5;
    for (size_t i = 0; i < segments; ++i) {
      points.push_back(any(random));
      durations.push_back(seconds(random));
    }
    std::vector<ThroughPoint> through;
    for (size_t i = 1; i < segments; ++i) {
      if (random() % 2 == 0) continue;
      through.push_back({i, any(random), share(random) * std::min(durations[i - 1], durations[i])});
    }
    const PseudoViaPoints pseudo = pseudo_via_points(points, durations, through);
    double least = 0.0;
    try {
      static_cast<void>(
          blended_lines(pseudo.points, pseudo.durations, std::array{1e-6}, pseudo.middles));
      ADD_FAILURE() << "accepted";
    } catch (const MotionError& error) {
      least = error.problem().limit.value();
    }
    const BlendedLines lines =
        blended_lines(pseudo.points, pseudo.durations, std::array{least}, pseudo.middles);
    EXPECT_THROW(static_cast<void>(blended_lines(pseudo.points, pseudo.durations,
                                                 std::array{0.999999 * least}, pseudo.middles)),
                 MotionError);
    expect_continuous(lines.law, 1, 1e-9);
    double t = 0.0;
    size_t next = 0;
    for (size_t i = 0; i + 1 < points.size(); ++i) {
      if (next < through.size() && through[next].index == i) {
        const AxisState there = lines.law.at(t);
        EXPECT_NEAR(there.q, points[i], 1e-10);
        EXPECT_NEAR(there.qd, through[next].velocity, 1e-8);
        ++next;
      }
      t += durations[i];
    }
    EXPECT_EQ(next, through.size());
    if (testing::Test::HasFailure()) return;
  }
}

TEST(PseudoViaPoints, RefusesBlendsThatCoverThePoint) {
  // The blend before takes 0.5 s, half of which is more than the 0.2 s to the point; the linear
  // part after it would be long enough on its own.
  const PseudoViaPoints pseudo = pseudo_via_points(std::array{0.0, 0.0, 1.0}, std::array{2.0, 2.0},
                                                   std::array{ThroughPoint{1, 0.5, 0.2}});
  EXPECT_NO_THROW(
      static_cast<void>(blended_lines(pseudo.points, pseudo.durations, std::array{1.12})));
  EXPECT_THROW(static_cast<void>(blended_lines(pseudo.points, pseudo.durations, std::array{1.12},
                                               pseudo.middles)),
               MotionError);
}

TEST(PseudoViaPoints, RefusesWhatDoesNotFit) {
  const std::array points{0.0, 1.0, 3.0};
  const std::array durations{2.0, 1.0};
  const auto with = [&](std::vector<ThroughPoint> through) {
    return pseudo_via_points(points, durations, through);
  };
  EXPECT_NO_THROW(static_cast<void>(with({})));
  EXPECT_THROW(static_cast<void>(with({{0, 0.5, 0.2}})), MotionError);
  EXPECT_THROW(static_cast<void>(with({{2, 0.5, 0.2}})), MotionError);
  EXPECT_THROW(static_cast<void>(with({{1, 0.5, 0.2}, {1, 0.5, 0.2}})), MotionError);
  EXPECT_THROW(static_cast<void>(with({{1, 0.5, 0.0}})), MotionError);
  EXPECT_THROW(static_cast<void>(with({{1, 0.5, 1.0}})), MotionError);
  EXPECT_THROW(static_cast<void>(with({{1, std::nan(""), 0.2}})), MotionError);
  EXPECT_THROW(static_cast<void>(
                   blended_lines(points, durations, std::array{50.0}, std::array<size_t, 1>{2})),
               MotionError);
}

}  // namespace
}  // namespace viapoint
