#include "viapoint/realtime/rate_limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "realtime/random_motion.hpp"

namespace viapoint {
namespace {

constexpr unsigned kStretches = 5000;

/// Path derivatives, rate and change of rate of one joint at one moment.
struct Moment {
  double first, second, third, rate, slope, curvature;

  [[nodiscard]] double acceleration() const { return second * rate * rate + first * slope; }
  [[nodiscard]] double jerk() const {
    return third * rate * rate * rate + 3.0 * second * rate * slope + first * curvature;
  }
};

class Problem {
 public:
  /// @param width of the ranges, 0 for single values
  Problem(unsigned seed, double width) : random_(seed), width_(width) {
    joints = std::uniform_int_distribution<int>(1, 7)(random_);
    limits = even_limits(joints, 2.0, 20.0, 200.0);
    for (int j = 0; j < joints; ++j) {
      limits.acceleration[j] *= uniform(0.2, 5.0);
      limits.jerk[j] *= uniform(0.2, 5.0);
      stretch.path.first.set(j, range(limits.velocity[j]));
      stretch.path.second.set(j, range(limits.acceleration[j]));
      stretch.path.third.set(j, range(limits.jerk[j]));
    }
    stretch.rate.low = uniform(0.0, 1.0 - width);
    stretch.rate.high = stretch.rate.low + width * uniform(0.0, 1.0);
    stretch.slope = range(4.0);
    stretch.curvature = uniform(-80.0, 80.0);
  }

  [[nodiscard]] double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  [[nodiscard]] double in(double low, double high) {  // the ends too: there is the worst
    const int where = std::uniform_int_distribution<int>(0, 3)(random_);
    return where == 0 ? low : where == 1 ? high : low + uniform(0.0, 1.0) * (high - low);
  }
  [[nodiscard]] Moment moment(int j) {
    const auto& [first, second, third] = stretch.path;
    return {in(first.low(j), first.high(j)),           in(second.low(j), second.high(j)),
            in(third.low(j), third.high(j)),           in(stretch.rate.low, stretch.rate.high),
            in(stretch.slope.low, stretch.slope.high), stretch.curvature};
  }
  [[nodiscard]] double share(int j, const Moment& moment) const {
    return std::max(std::abs(moment.acceleration()) / limits.acceleration[j],
                    std::abs(moment.jerk()) / limits.jerk[j]);
  }

  JointLimits limits;
  RateStretch stretch;
  int joints;

 private:
  Range range(double largest) {
    const double low = uniform(-largest, largest);
    return {low, std::min(largest, low + width_ * uniform(0.0, largest))};
  }

  std::mt19937 random_;
  double width_;
};

TEST(RateLimits, WhatIsKeptForRangesIsKeptForEveryMoment) {
  int kept = 0, refused = 0;
  for (unsigned seed = 0; seed < kStretches; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Problem problem(seed, 0.2);
    if (!RateLimits(problem.limits).kept(problem.stretch)) {
      ++refused;
      continue;
    }
    ++kept;
    for (int j = 0; j < problem.joints; ++j) {
      for (int s = 0; s < 50; ++s) {
        ASSERT_LE(problem.share(j, problem.moment(j)), 1.0 + 2e-9) << "joint " << j;
      }
    }
  }
  EXPECT_GT(kept, 200);
  EXPECT_GT(refused, 200);
}

TEST(RateLimits, OfSingleValuesItRefusesOnlyWhatBreaksALimit) {
  int kept = 0, refused = 0;
  for (unsigned seed = 0; seed < kStretches; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Problem problem(seed, 0.0);
    double worst = 0.0;
    for (int j = 0; j < problem.joints; ++j) {
      worst = std::max(worst, problem.share(j, problem.moment(j)));
    }
    const bool answer = RateLimits(problem.limits).kept(problem.stretch);
    ++(answer ? kept : refused);
    ASSERT_EQ(answer, worst <= 1.0 + 1e-9) << worst;
  }
  EXPECT_GT(kept, 200);
  EXPECT_GT(refused, 200);
}

TEST(RateLimits, KeepNothingThatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  int planted = 0;
  for (unsigned seed = 0; planted < 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Problem problem(seed, 0.2);
    const RateLimits limits(problem.limits);
    if (!limits.kept(problem.stretch)) continue;
    for (const double poison : {kNan, kInfinity, -kInfinity}) {
      const auto plant = [&](auto&& where) {
        RateStretch stretch = problem.stretch;
        where(stretch) = poison;
        ASSERT_FALSE(limits.kept(stretch)) << poison;
        ++planted;
      };
      for (int j = 0; j < problem.joints; ++j) {
        const auto pair = static_cast<std::size_t>(j / 2);
        plant([&](RateStretch& s) -> double& { return s.path.first.pair[pair].low[j % 2]; });
        plant([&](RateStretch& s) -> double& { return s.path.first.pair[pair].high[j % 2]; });
        plant([&](RateStretch& s) -> double& { return s.path.second.pair[pair].low[j % 2]; });
        plant([&](RateStretch& s) -> double& { return s.path.second.pair[pair].high[j % 2]; });
        plant([&](RateStretch& s) -> double& { return s.path.third.pair[pair].low[j % 2]; });
        plant([&](RateStretch& s) -> double& { return s.path.third.pair[pair].high[j % 2]; });
      }
      plant([](RateStretch& s) -> double& { return s.rate.low; });
      plant([](RateStretch& s) -> double& { return s.rate.high; });
      plant([](RateStretch& s) -> double& { return s.slope.low; });
      plant([](RateStretch& s) -> double& { return s.slope.high; });
      plant([](RateStretch& s) -> double& { return s.curvature; });
    }
  }
}

/// The largest share over all joints at the start and, a `time` later, at the end of a push.
double worst_of_push(Problem& problem, double time, double curvature) {
  double worst = 0.0;
  for (int j = 0; j < problem.joints; ++j) {
    Moment moment = problem.moment(j);
    moment.slope = problem.stretch.slope.low;
    moment.curvature = curvature;
    worst = std::max(worst, std::abs(moment.jerk()) / problem.limits.jerk[j]);
    moment.slope += time * curvature;
    worst = std::max(worst, problem.share(j, moment));
  }
  return worst;
}

TEST(RateLimits, TheStrongestPushAndAnyWeakerOneKeepTheLimits) {
  int found = 0, forced = 0;
  for (unsigned seed = 0; seed < kStretches; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Problem problem(seed, 0.1);
    const double time = problem.uniform(0.002, 0.02);
    const double wished = problem.uniform(-1e4, 1e4);
    double strongest = wished;
    if (!RateLimits(problem.limits).strongest(problem.stretch, time, strongest)) continue;
    ++found;
    const bool is_forced = strongest * wished < 0.0 || std::abs(strongest) > std::abs(wished);
    forced += is_forced ? 1 : 0;
    double none = 0.0;
    const bool may_rest =
        RateLimits(problem.limits).strongest(problem.stretch, time, none) && none == 0.0;
    for (int s = 0; s < 50; ++s) {
      const double push = may_rest ? problem.in(0.0, strongest) : strongest;
      ASSERT_LE(worst_of_push(problem, time, push), 1.0 + 2e-9) << "push " << push;
    }
  }
  EXPECT_GT(found, 200);
  EXPECT_GT(forced, 10) << "where the joints leave no choice but to push";
}

TEST(RateLimits, OfSingleValuesTheStrongestPushReachesALimit) {
  int found = 0, forced = 0;
  for (unsigned seed = 0; seed < kStretches; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Problem problem(seed, 0.0);
    const double time = problem.uniform(0.002, 0.02);
    constexpr double kMost = 1e4;
    double least = 0.0;
    if (!RateLimits(problem.limits).strongest(problem.stretch, time, least)) continue;
    ++found;
    if (least != 0.0) {
      ++forced;
      ASSERT_NEAR(worst_of_push(problem, time, least), 1.0, 1e-6);
    }
    for (const double wished : {kMost, -kMost}) {
      double strongest = wished;
      ASSERT_TRUE(RateLimits(problem.limits).strongest(problem.stretch, time, strongest));
      if (strongest == wished) continue;
      ASSERT_NEAR(worst_of_push(problem, time, strongest), 1.0, 1e-6);
    }
  }
  EXPECT_GT(found, 200);
  EXPECT_GT(forced, 50) << "where the joints leave no choice but to push";
}

TEST(RateLimits, AllowNoPushWhereAnythingIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  int planted = 0;
  for (unsigned seed = 0; planted < 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Problem problem(seed, 0.1);
    const RateLimits limits(problem.limits);
    double push = 100.0;
    if (!limits.strongest(problem.stretch, 0.01, push)) continue;
    const auto plant = [&](auto&& where) {
      RateStretch stretch = problem.stretch;
      where(stretch) = kNan;
      double poisoned = 100.0;
      ASSERT_FALSE(limits.strongest(stretch, 0.01, poisoned));
      ++planted;
    };
    for (int j = 0; j < problem.joints; ++j) {
      const auto pair = static_cast<std::size_t>(j / 2);
      plant([&](RateStretch& s) -> double& { return s.path.first.pair[pair].low[j % 2]; });
      plant([&](RateStretch& s) -> double& { return s.path.second.pair[pair].high[j % 2]; });
      plant([&](RateStretch& s) -> double& { return s.path.third.pair[pair].low[j % 2]; });
    }
    plant([](RateStretch& s) -> double& { return s.rate.high; });
    plant([](RateStretch& s) -> double& { return s.slope.low; });
    double nothing = kNan;
    ASSERT_FALSE(limits.strongest(problem.stretch, 0.01, nothing));
  }
}

TEST(RateLimits, LeaveAJointThatDoesNotMoveOutOfAccount) {
  const RateLimits limits(even_limits(3, 2.0, 20.0, 200.0));
  RateStretch stretch;
  stretch.path.first.set(1, {1.0, 1.0});
  stretch.rate = {0.5, 0.5};
  for (const double wished : {1e6, -1e6}) {
    double push = wished;
    ASSERT_TRUE(limits.strongest(stretch, 0.01, push));
    EXPECT_NEAR(push, std::copysign(200.0, wished), 1e-6);
  }
}

}  // namespace
}  // namespace viapoint
