#include "viapoint/profile/state_to_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "problem_count.hpp"
#include "profile/axis_move_checks.hpp"

namespace viapoint {
namespace {

using testing::AxisRequest;
using testing::expect_connected;
using testing::expect_limits;
using testing::log_uniform;
using testing::uniform;

constexpr AxisLimits kPlain = AxisLimits::symmetric(1.0, 2.0, 10.0);

struct Requests {
  std::vector<AxisState> start, end;
  std::vector<AxisLimits> limits;

  void add(const AxisRequest& r) {
    start.push_back(r.start);
    end.push_back(r.end);
    limits.push_back(r.limits);
  }
  [[nodiscard]] size_t size() const { return start.size(); }
  [[nodiscard]] AxisRequest axis(size_t i) const { return {start[i], end[i], limits[i]}; }
};

Requests random_requests(std::mt19937_64& random, int joints) {
  Requests all;
  for (int i = 0; i < joints; ++i) {
    all.add(random() % 3 == 0 ? testing::random_short_request(random)
                              : testing::random_request(random, 0.7));
  }
  return all;
}

void expect_sound(const Requests& all, const StateToState& motion) {
  ASSERT_EQ(motion.joints(), static_cast<int>(all.size()));
  for (size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE("axis " + std::to_string(i));
    expect_connected(all.axis(i), motion.axis(static_cast<int>(i)));
    expect_limits(all.axis(i), motion.axis(static_cast<int>(i)));
  }
}

double quickest(const AxisRequest& r) {
  AxisMove move;
  EXPECT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
  return move.total;
}

TEST(StateToState, TakesTheTimeOfTheSlowestAxisOrJustAsMuchMoreAsAnAxisNeeds) {
  int longer = 0;
  for (int seed = 0; seed < problems(10000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const Requests all = random_requests(random, 1 + static_cast<int>(random() % 7));
    StateToState motion;
    ASSERT_EQ(motion.plan(all.start, all.end, all.limits), MoveStatus::kSolved);
    expect_sound(all, motion);
    double slowest = 0.0;
    for (size_t i = 0; i < all.size(); ++i) {
      slowest = std::max(slowest, quickest(all.axis(i)));
      EXPECT_EQ(motion.axis(static_cast<int>(i)).total, motion.duration());
    }
    EXPECT_GE(motion.duration(), slowest);
    if (motion.duration() > slowest) ++longer;
    // No duration between the slowest axis' and the common one suits them all.
    for (int k = 0; k < 5 && motion.duration() > slowest; ++k) {
      StateToStateOptions options;
      options.least_duration = uniform(random, slowest, motion.duration());
      StateToState other;
      ASSERT_EQ(other.plan(all.start, all.end, all.limits, options), MoveStatus::kSolved);
      EXPECT_NEAR(other.duration(), motion.duration(), 1e-9 * motion.duration());
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(longer, problems(1000));  // that there are axes with impossible durations among them
}

TEST(StateToState, LastsAsLongAsAskedOrUntilTheNextPossibleDuration) {
  int exact = 0;
  for (int seed = 0; seed < problems(20000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    Requests all;
    all.add(random() % 2 == 0 ? testing::random_short_request(random)
                              : testing::random_request(random, 0.7));
    StateToStateOptions options;
    options.least_duration = quickest(all.axis(0)) * uniform(random, 1.0, 4.0);
    StateToState motion;
    ASSERT_EQ(motion.plan(all.start, all.end, all.limits, options), MoveStatus::kSolved);
    expect_sound(all, motion);
    EXPECT_GE(motion.duration(), options.least_duration);
    if (motion.duration() == options.least_duration) ++exact;
    if (HasFailure()) return;
  }
  EXPECT_GT(exact, problems(10000));
}

TEST(StateToState, PassesOverADurationThatWouldOvershoot) {
  // Before the target at full speed, to cross it at full speed: slower in between, it would be past
  // the target before it is slow enough. It has to stop, go back and start anew.
  Requests all;
  all.add({{0.0, 1.0, 0.0, 0.0}, {0.1, 1.0, 0.0, 0.0}, kPlain});
  StateToStateOptions options;
  options.least_duration = 0.5;
  StateToState motion;
  ASSERT_EQ(motion.plan(all.start, all.end, all.limits, options), MoveStatus::kSolved);
  expect_sound(all, motion);
  EXPECT_GT(motion.duration(), 1.4);  // a stop and a start, each 1/2 + 2/10 s, and the way back
  EXPECT_LT(motion.duration(), 2.8);
}

TEST(StateToState, RoundsUpToWholeCycles) {
  for (int seed = 0; seed < problems(5000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const Requests all = random_requests(random, 3);
    StateToStateOptions options;
    options.cycle = 0.002;
    StateToState motion, free;
    ASSERT_EQ(motion.plan(all.start, all.end, all.limits, options), MoveStatus::kSolved);
    ASSERT_EQ(free.plan(all.start, all.end, all.limits), MoveStatus::kSolved);
    expect_sound(all, motion);
    const double cycles = motion.duration() / options.cycle;
    EXPECT_NEAR(cycles, std::round(cycles), 1e-6);
    EXPECT_GE(motion.duration(), free.duration() * (1.0 - 1e-12));
    if (HasFailure()) return;
  }
}

TEST(StateToState, LeavesAxesToThemselvesWithoutSynchronization) {
  std::mt19937_64 random(1);
  const Requests all = random_requests(random, 7);
  StateToStateOptions options;
  options.synchronization = Synchronization::kNone;
  StateToState motion;
  ASSERT_EQ(motion.plan(all.start, all.end, all.limits, options), MoveStatus::kSolved);
  expect_sound(all, motion);
  double slowest = 0.0;
  for (size_t i = 0; i < all.size(); ++i) {
    const double own = quickest(all.axis(i));
    EXPECT_EQ(motion.axis(static_cast<int>(i)).total, own);
    slowest = std::max(slowest, own);
  }
  EXPECT_EQ(motion.duration(), slowest);
}

TEST(StateToState, LetsAnAxisThatHasArrivedGoOnAtItsEndVelocity) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const Requests all = random_requests(random, 3);
    StateToStateOptions options;
    options.synchronization = Synchronization::kNone;
    StateToState motion;
    ASSERT_EQ(motion.plan(all.start, all.end, all.limits, options), MoveStatus::kSolved);
    for (const double t : {0.0, uniform(random, 0.0, motion.duration()), motion.duration(),
                           2.0 * motion.duration()}) {
      const JointState state = motion.at(t);
      for (int i = 0; i < 3; ++i) {
        const AxisMove& move = motion.axis(i);
        const double over = std::min(t, motion.duration()) - move.total;
        const AxisState& end = all.end[static_cast<size_t>(i)];
        if (over > 0.0) {
          EXPECT_EQ(state.q[i], end.q + over * end.qd);
          EXPECT_EQ(state.qd[i], end.qd);
          EXPECT_EQ(state.qdd[i], 0.0);
        } else {
          EXPECT_EQ(state.q[i], move.at(t).q);
          EXPECT_EQ(state.qdd[i], move.at(t).qdd);
        }
      }
    }
    if (HasFailure()) return;
  }
}

/// All axes' states are multiples of one direction, of both signs and very different lengths.
Requests random_line(std::mt19937_64& random, std::vector<double>& direction) {
  Requests all;
  const size_t n = 1 + random() % 7;
  AxisLimits tightest{-1e300, 1e300, -1e300, 1e300, -1e300, 1e300};
  for (size_t i = 0; i < n; ++i) {
    all.add(testing::random_request(random, 0.7));
    direction.push_back(log_uniform(random, 1e-3, 1.0) * (random() % 2 == 0 ? 1.0 : -1.0));
    const double d = direction.back();
    const auto tighten = [&](double low, double high, double& least, double& most) {
      least = std::max(least, std::min(low / d, high / d));
      most = std::min(most, std::max(low / d, high / d));
    };
    const AxisLimits& l = all.limits.back();
    tighten(l.velocity_min, l.velocity_max, tightest.velocity_min, tightest.velocity_max);
    tighten(l.acceleration_min, l.acceleration_max, tightest.acceleration_min,
            tightest.acceleration_max);
    tighten(l.jerk_min, l.jerk_max, tightest.jerk_min, tightest.jerk_max);
  }
  const AxisState from = testing::random_state(random, tightest);
  const AxisState to = testing::random_state(random, tightest);
  const double way = uniform(random, -2.0, 2.0);
  for (size_t i = 0; i < n; ++i) {
    const double d = direction[i];
    all.start[i] = {0.3, d * from.qd, d * from.qdd, 0.0};
    all.end[i] = {0.3 + d * way, d * to.qd, d * to.qdd, 0.0};
  }
  return all;
}

TEST(StateToState, StaysOnTheStraightLine) {
  for (int seed = 0; seed < problems(5000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::vector<double> direction;
    const Requests all = random_line(random, direction);
    StateToStateOptions options;
    options.synchronization = Synchronization::kLine;
    if (seed % 2 == 0) options.cycle = 0.004;
    StateToState motion;
    ASSERT_EQ(motion.plan(all.start, all.end, all.limits, options), MoveStatus::kSolved);
    for (size_t i = 0; i < all.size(); ++i) {
      expect_limits(all.axis(i), motion.axis(static_cast<int>(i)));
      EXPECT_EQ(motion.axis(static_cast<int>(i)).end.q, all.end[i].q);
    }
    for (int k = 0; k <= 20; ++k) {
      const JointState state = motion.at(motion.duration() * k / 20.0);
      const double along = (state.q[0] - 0.3) / direction[0];
      for (size_t i = 1; i < all.size(); ++i) {
        const auto joint = static_cast<Eigen::Index>(i);
        EXPECT_NEAR(state.q[joint], 0.3 + along * direction[i], 1e-9);
      }
    }
    // Along the line is never quicker than each on its own.
    StateToState free;
    options.synchronization = Synchronization::kNone;
    options.cycle = 0.0;
    ASSERT_EQ(free.plan(all.start, all.end, all.limits, options), MoveStatus::kSolved);
    EXPECT_GE(motion.duration(), free.duration() * (1.0 - 1e-9));
    if (HasFailure()) return;
  }
}

TEST(StateToState, RefusesALineThatTheEndsAreNotOn) {
  Requests all;
  all.add({{0.0, 0.1, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, kPlain});
  all.add({{0.0, 0.1, 0.0, 0.0}, {0.5, 0.0, 0.0, 0.0}, kPlain});
  StateToStateOptions options;
  options.synchronization = Synchronization::kLine;
  StateToState motion;
  EXPECT_EQ(motion.plan(all.start, all.end, all.limits, options), MoveStatus::kNotParallel);
  EXPECT_GE(motion.culprit(), 0);
  EXPECT_EQ(motion.joints(), 0);
  all.start[1].qd = 0.05;
  EXPECT_EQ(motion.plan(all.start, all.end, all.limits, options), MoveStatus::kSolved);
}

TEST(StateToState, NamesTheAxisThatRefuses) {
  Requests all;
  all.add({{}, {1.0, 0.0, 0.0, 0.0}, kPlain});
  all.add({{}, {1.0, 3.0, 0.0, 0.0}, kPlain});
  StateToState motion;
  EXPECT_EQ(motion.plan(all.start, all.end, all.limits), MoveStatus::kEndVelocity);
  EXPECT_EQ(motion.culprit(), 1);
  EXPECT_EQ(motion.duration(), 0.0);
  EXPECT_EQ(motion.plan(all.start, all.end, {}), MoveStatus::kBadSize);
  EXPECT_EQ(motion.plan({}, {}, {}), MoveStatus::kBadSize);
  const std::vector<AxisState> many(kMaxJoints + 1);
  const std::vector<AxisLimits> their(kMaxJoints + 1, kPlain);
  EXPECT_EQ(motion.plan(many, many, their), MoveStatus::kBadSize);
  StateToStateOptions options;
  options.least_duration = std::numeric_limits<double>::infinity();
  all.end[1].qd = 0.0;
  EXPECT_EQ(motion.plan(all.start, all.end, all.limits, options), MoveStatus::kDurationImpossible);
}

/// Plans anew in every cycle from where the last plan is by then.
TEST(StateToState, FollowsATargetThatChangesInEveryCycle) {
  constexpr double kCycle = 0.002;
  for (int seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    Requests all;
    for (int i = 0; i < 3; ++i) all.add({{}, {}, testing::random_request(random, 0.5).limits});
    StateToState motion;
    for (int cycle = 0; cycle < 6000; ++cycle) {
      for (size_t i = 0; i < 3; ++i) {
        if (cycle < 1000) all.end[i].q = uniform(random, -1.0, 1.0);
      }
      ASSERT_EQ(motion.plan(all.start, all.end, all.limits), MoveStatus::kSolved);
      for (size_t i = 0; i < 3; ++i) {
        expect_limits(all.axis(i), motion.axis(static_cast<int>(i)));
        all.start[i] = motion.axis(static_cast<int>(i)).at(kCycle);
      }
      if (HasFailure()) return;
    }
    // 10 s after the last change all have arrived, and rest.
    EXPECT_EQ(motion.duration(), 0.0);
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(all.start[i].q, all.end[i].q);
      EXPECT_EQ(all.start[i].qd, 0.0);
      EXPECT_EQ(all.start[i].qdd, 0.0);
    }
  }
}

TEST(StateToState, DoesNotSwingAroundATargetThatIsNoisy) {
  constexpr double kCycle = 0.002, kNoise = 1e-7;
  std::mt19937_64 random(3);
  Requests all;
  for (int i = 0; i < 3; ++i) all.add({{}, {}, kPlain});
  StateToState motion;
  for (int cycle = 0; cycle < 20000; ++cycle) {
    for (size_t i = 0; i < 3; ++i) all.end[i].q = uniform(random, -kNoise, kNoise);
    ASSERT_EQ(motion.plan(all.start, all.end, all.limits), MoveStatus::kSolved);
    for (size_t i = 0; i < 3; ++i) {
      all.start[i] = motion.axis(static_cast<int>(i)).at(kCycle);
      // Full jerk takes (32·2e-7/10)^(1/3) = 9 ms for the noise: it is not left by much.
      ASSERT_LE(std::abs(all.start[i].q), 5.0 * kNoise);
    }
  }
}

TEST(StateToState, ServesAsManyAxesAsAnArmMayHave) {
  std::mt19937_64 random(2);
  const Requests all = random_requests(random, kMaxJoints);
  StateToState motion;
  ASSERT_EQ(motion.plan(all.start, all.end, all.limits), MoveStatus::kSolved);
  expect_sound(all, motion);
}

}  // namespace
}  // namespace viapoint
