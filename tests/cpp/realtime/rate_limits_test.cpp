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
      DerivativeRanges& ranges = stretch.path.ranges;
      ranges.first.set(j, range(limits.velocity[j]));
      ranges.second.set(j, range(limits.acceleration[j]));
      ranges.third.set(j, range(limits.jerk[j]));
      stretch.path.first_there.set(j, part_of(ranges.first, j));
      stretch.path.second_there.set(j, part_of(ranges.second, j));
    }
    stretch.rate.low = uniform(0.0, 1.0 - width);
    stretch.rate.high = stretch.rate.low + width * uniform(0.0, 1.0);
    stretch.slope = range(4.0);
    stretch.curvature = uniform(-80.0, 80.0);
    stretch.begin(in(stretch.rate.low, stretch.rate.high),
                  in(stretch.slope.low, stretch.slope.high), uniform(0.002, 0.02));
  }

  [[nodiscard]] double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  [[nodiscard]] double in(double low, double high) {  // the ends too: there is the worst
    const int where = std::uniform_int_distribution<int>(0, 3)(random_);
    return where == 0 ? low : where == 1 ? high : low + uniform(0.0, 1.0) * (high - low);
  }
  [[nodiscard]] Moment moment(int j) {
    const auto& [first, second, third] = stretch.path.ranges;
    return {in(first.low(j), first.high(j)),           in(second.low(j), second.high(j)),
            in(third.low(j), third.high(j)),           in(stretch.rate.low, stretch.rate.high),
            in(stretch.slope.low, stretch.slope.high), stretch.curvature};
  }
  /// Where the stretch begins.
  [[nodiscard]] Moment first_moment(int j) {
    const auto& [ranges, first, second] = stretch.path;
    return {in(first.low(j), first.high(j)),
            in(second.low(j), second.high(j)),
            in(ranges.third.low(j), ranges.third.high(j)),
            stretch.first_rate,
            stretch.first_slope,
            stretch.curvature};
  }

  JointLimits limits;
  RateStretch stretch;
  int joints;

 private:
  Range range(double largest) {
    const double low = uniform(-largest, largest);
    return {low, std::min(largest, low + width_ * uniform(0.0, largest))};
  }
  Range part_of(const JointRanges& ranges, int joint) {
    const double a = in(ranges.low(joint), ranges.high(joint));
    const double b = in(ranges.low(joint), ranges.high(joint));
    return {std::min(a, b), std::max(a, b)};
  }

  std::mt19937 random_;
  double width_;
};

/// The worst shares of one joint's limits that come up in a stretch. Its acceleration is what the
/// path's derivatives and the rate make of it, and also what it is at the start plus what the jerk
/// adds to that: of a real motion the same, of ranges each a bound, so that one of them is enough.
class Worst {
 public:
  Worst(const Problem& problem, int joint)
      : acceleration_limit_(problem.limits.acceleration[joint]),
        jerk_limit_(problem.limits.jerk[joint]),
        time_(problem.stretch.time) {}

  void see(const Moment& first, const Moment& moment, double share_of_time) {
    const double drift = time_ * share_of_time * moment.jerk();
    by_values_ = std::max(by_values_, std::abs(moment.acceleration()));
    by_drift_ = std::max(
        {by_drift_, std::abs(first.acceleration()), std::abs(first.acceleration() + drift)});
    jerk_ = std::max(jerk_, std::abs(moment.jerk()));
  }
  [[nodiscard]] double share() const {
    return std::max(std::min(by_values_, by_drift_) / acceleration_limit_, jerk_ / jerk_limit_);
  }
  /// Whether a limit is just reached, by either reckoning.
  [[nodiscard]] bool reaches_a_limit() const {
    constexpr double kNear = 1e-6;
    return std::abs(by_values_ - acceleration_limit_) < kNear * acceleration_limit_ ||
           std::abs(by_drift_ - acceleration_limit_) < kNear * acceleration_limit_ ||
           std::abs(jerk_ - jerk_limit_) < kNear * jerk_limit_;
  }

 private:
  double acceleration_limit_, jerk_limit_, time_;
  double by_values_ = 0.0, by_drift_ = 0.0, jerk_ = 0.0;
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
      Worst worst(problem, j);
      for (int s = 0; s < 50; ++s) {
        worst.see(problem.first_moment(j), problem.moment(j), problem.in(0.0, 1.0));
      }
      ASSERT_LE(worst.share(), 1.0 + 2e-9) << "joint " << j;
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
      Worst of_joint(problem, j);
      of_joint.see(problem.first_moment(j), problem.moment(j), 1.0);
      worst = std::max(worst, of_joint.share());
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
        plant([&](RateStretch& s) -> double& { return s.path.ranges.first.pair[pair].low[j % 2]; });
        plant(
            [&](RateStretch& s) -> double& { return s.path.ranges.first.pair[pair].high[j % 2]; });
        plant(
            [&](RateStretch& s) -> double& { return s.path.ranges.second.pair[pair].low[j % 2]; });
        plant(
            [&](RateStretch& s) -> double& { return s.path.ranges.second.pair[pair].high[j % 2]; });
        plant([&](RateStretch& s) -> double& { return s.path.ranges.third.pair[pair].low[j % 2]; });
        plant(
            [&](RateStretch& s) -> double& { return s.path.ranges.third.pair[pair].high[j % 2]; });
      }
      plant([](RateStretch& s) -> double& { return s.rate.low; });
      plant([](RateStretch& s) -> double& { return s.rate.high; });
      plant([](RateStretch& s) -> double& { return s.slope.low; });
      plant([](RateStretch& s) -> double& { return s.slope.high; });
      plant([](RateStretch& s) -> double& { return s.curvature; });
    }
  }
}

/// What comes up in one joint at the start and at the end of a push.
Worst worst_of_push(Problem& problem, int joint, double curvature, int samples) {
  Worst worst(problem, joint);
  for (int s = 0; s < samples; ++s) {
    const Moment first = problem.first_moment(joint);
    for (const double time : {0.0, problem.stretch.time}) {
      Moment moment = problem.moment(joint);
      moment.slope = problem.stretch.first_slope + time * curvature;
      moment.curvature = curvature;
      worst.see(first, moment, 1.0);
    }
  }
  return worst;
}

/// Asserts that a push keeps all limits, and reaches one.
void expect_at_a_limit(Problem& problem, double curvature) {
  bool reaches = false;
  for (int j = 0; j < problem.joints; ++j) {
    const Worst worst = worst_of_push(problem, j, curvature, 1);
    ASSERT_LE(worst.share(), 1.0 + 2e-9) << "joint " << j;
    reaches = reaches || worst.reaches_a_limit();
  }
  ASSERT_TRUE(reaches) << "a stronger push would do, too";
}

TEST(RateLimits, TheStrongestPushAndAnyWeakerOneKeepTheLimits) {
  int found = 0, forced = 0;
  for (unsigned seed = 0; seed < kStretches; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Problem problem(seed, 0.1);
    const double wished = problem.uniform(-1e4, 1e4);
    double strongest = wished;
    if (!RateLimits(problem.limits).strongest(problem.stretch, strongest)) continue;
    ++found;
    const bool is_forced = strongest * wished < 0.0 || std::abs(strongest) > std::abs(wished);
    forced += is_forced ? 1 : 0;
    double none = 0.0;
    const bool may_rest =
        RateLimits(problem.limits).strongest(problem.stretch, none) && none == 0.0;
    for (int s = 0; s < 10; ++s) {
      const double push = may_rest ? problem.in(0.0, strongest) : strongest;
      for (int j = 0; j < problem.joints; ++j) {
        ASSERT_LE(worst_of_push(problem, j, push, 5).share(), 1.0 + 2e-9) << "push " << push;
      }
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
    constexpr double kMost = 1e4;
    double least = 0.0;
    if (!RateLimits(problem.limits).strongest(problem.stretch, least)) continue;
    ++found;
    if (least != 0.0) {
      ++forced;
      ASSERT_NO_FATAL_FAILURE(expect_at_a_limit(problem, least));
    }
    for (const double wished : {kMost, -kMost}) {
      double strongest = wished;
      ASSERT_TRUE(RateLimits(problem.limits).strongest(problem.stretch, strongest));
      if (strongest == wished) continue;
      ASSERT_NO_FATAL_FAILURE(expect_at_a_limit(problem, strongest));
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
    if (!limits.strongest(problem.stretch, push)) continue;
    const auto plant = [&](auto&& where) {
      RateStretch stretch = problem.stretch;
      where(stretch) = kNan;
      double poisoned = 100.0;
      ASSERT_FALSE(limits.strongest(stretch, poisoned));
      ++planted;
    };
    for (int j = 0; j < problem.joints; ++j) {
      const auto pair = static_cast<std::size_t>(j / 2);
      plant([&](RateStretch& s) -> double& { return s.path.ranges.first.pair[pair].low[j % 2]; });
      plant([&](RateStretch& s) -> double& { return s.path.ranges.second.pair[pair].high[j % 2]; });
      plant([&](RateStretch& s) -> double& { return s.path.ranges.third.pair[pair].low[j % 2]; });
    }
    plant([](RateStretch& s) -> double& { return s.rate.high; });
    plant([](RateStretch& s) -> double& { return s.first_slope; });
    plant([](RateStretch& s) -> double& { return s.first_rate; });
    double nothing = kNan;
    ASSERT_FALSE(limits.strongest(problem.stretch, nothing));
  }
}

TEST(RateLimits, LeaveAJointThatDoesNotMoveOutOfAccount) {
  const RateLimits limits(even_limits(3, 2.0, 20.0, 200.0));
  RateStretch stretch;
  stretch.path.ranges.first.set(1, {1.0, 1.0});
  stretch.path.first_there.set(1, {1.0, 1.0});
  stretch.rate = {0.5, 0.5};
  stretch.begin(0.5, 0.0, 0.01);
  for (const double wished : {1e6, -1e6}) {
    double push = wished;
    ASSERT_TRUE(limits.strongest(stretch, push));
    EXPECT_NEAR(push, std::copysign(200.0, wished), 1e-6);
  }
}

}  // namespace
}  // namespace viapoint
