// Position limits of one axis during the motion.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "problem_count.hpp"
#include "profile/axis_move_checks.hpp"
#include "profile/walled_moves.hpp"
#include "viapoint/profile/axis_move.hpp"

namespace viapoint {
namespace {

using testing::AxisRequest;
using testing::between;
using testing::expect_connected;
using testing::expect_inside;
using testing::expect_limits;
using testing::Extent;
using testing::extent_of;
using testing::kNone;
using testing::log_uniform;
using testing::random_walled_request;
using testing::uniform;
using testing::without_walls;

TEST(PositionLimits, HoldAllTheWay) {
  int longer = 0;
  for (int seed = 0; seed < problems(10000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const AxisRequest r = random_walled_request(random);
    AxisMove move, free;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
    ASSERT_EQ(quickest_move(r.start, r.end, without_walls(r.limits), free), MoveStatus::kSolved);
    expect_connected(r, move);
    expect_limits(r, move);
    expect_inside(r.limits, move);
    EXPECT_GE(move.total, free.total * (1.0 - 1e-12));
    if (move.total > free.total * (1.0 + 1e-9)) ++longer;
    if (HasFailure()) return;
  }
  EXPECT_GT(longer, problems(2500));  // that the walls were in the way
}

/// The sum of the two ways, infinite where one leaves the walls.
double through(const AxisRequest& r, const AxisState& middle) {
  AxisMove first, second;
  const AxisLimits free = without_walls(r.limits);
  if (quickest_move(r.start, middle, free, first) != MoveStatus::kSolved ||
      quickest_move(middle, r.end, free, second) != MoveStatus::kSolved) {
    return kNone;
  }
  for (const AxisMove* move : {&first, &second}) {
    const Extent extent = extent_of(*move);
    if (extent.high > r.limits.position_max || extent.low < r.limits.position_min) return kNone;
  }
  return first.total + second.total;
}

TEST(PositionLimits, CostNoMoreTimeThanAnyTouchOfAFineGrid) {
  int compared = 0;
  for (int seed = 0; seed < problems(600); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const AxisRequest r = random_walled_request(random);
    AxisMove move;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
    double best = kNone;
    for (int i = 0; i <= 400; ++i) {
      const double share = i / 400.0;
      const AxisState high{r.limits.position_max, 0.0, share * r.limits.acceleration_min, 0.0};
      const AxisState low{r.limits.position_min, 0.0, share * r.limits.acceleration_max, 0.0};
      for (const AxisState& touch : {high, low}) {
        // Getting rid of the acceleration must not break the velocity limits.
        const double away = touch.qdd < 0.0 ? r.limits.jerk_max : r.limits.jerk_min;
        const double after = -0.5 * touch.qdd * touch.qdd / away;
        const bool holds = after <= r.limits.velocity_max && after >= r.limits.velocity_min;
        if (std::isfinite(touch.q) && holds) best = std::min(best, through(r, touch));
      }
    }
    if (std::isfinite(best)) ++compared;
    EXPECT_LE(move.total, best * (1.0 + 1e-7));
    if (HasFailure()) return;
  }
  EXPECT_GT(compared, problems(300));
}

TEST(PositionLimits, CostNoMoreTimeThanRandomDetours) {
  int compared = 0;
  for (int seed = 0; seed < problems(1000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const AxisRequest r = random_walled_request(random);
    AxisMove move;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
    const Extent extent = extent_of(move);
    for (int k = 0; k < 100; ++k) {
      AxisState middle = testing::random_state(random, r.limits);
      middle.q = uniform(random, extent.low, extent.high);
      const double other = through(r, middle);
      if (std::isfinite(other)) ++compared;
      EXPECT_GE(other, move.total * (1.0 - 1e-9));
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(compared, problems(5000));
}

TEST(PositionLimits, NameWhatCannotBe) {
  AxisMove move;
  const auto status = [&](const AxisState& start, const AxisState& end, const AxisLimits& limits) {
    return quickest_move(start, end, limits, move);
  };
  EXPECT_EQ(status({}, {1.0, 0.0, 0.0, 0.0}, between(0.0, 0.9)), MoveStatus::kEndPosition);
  EXPECT_EQ(status({}, {-0.1, 0.0, 0.0, 0.0}, between(0.0, 0.9)), MoveStatus::kEndPosition);
  // From 1 to 0 at jerk 10 and acceleration 2: 0.2 s falling, 0.4 s held, and then it stands. The
  // way is 0.2 − 10·0.008/6 + 0.8·0.4 − 2·0.08 = 0.3467.
  const AxisState fast{0.0, 1.0, 0.0, 0.0};
  EXPECT_EQ(status(fast, {}, between(-1.0, 0.3466)), MoveStatus::kStartTooFast);
  EXPECT_EQ(status(fast, {}, between(-1.0, 0.3467)), MoveStatus::kSolved);
  EXPECT_EQ(status({0.0, -1.0, 0.0, 0.0}, {}, between(-0.3466, 1.0)), MoveStatus::kStartTooFast);
  EXPECT_EQ(status({}, {0.0, -1.0, 0.0, 0.0}, between(-1.0, 0.3466)), MoveStatus::kEndTooFast);
  EXPECT_EQ(status({}, {0.0, -1.0, 0.0, 0.0}, between(-1.0, 0.3467)), MoveStatus::kSolved);
  // At the upper wall it brakes at 2, and takes ⅔·2³/10² = 0.0533 to get over that.
  const AxisState slow{0.0, 0.2, 0.0, 0.0};
  EXPECT_EQ(status(slow, {}, between(-0.005, 0.02667)), MoveStatus::kNoRoom);
  EXPECT_EQ(status(slow, {}, between(-0.0268, 0.02667)), MoveStatus::kSolved);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(status({}, {}, between(0.1, -0.1)), MoveStatus::kBadLimits);
  EXPECT_EQ(status({}, {}, between(nan, 1.0)), MoveStatus::kBadLimits);
  EXPECT_EQ(status({}, {}, between(kNone, kNone)), MoveStatus::kBadLimits);
  EXPECT_EQ(status({}, {}, between(-kNone, -kNone)), MoveStatus::kBadLimits);
  EXPECT_EQ(status({}, {}, between(0.0, 0.0)), MoveStatus::kSolved);
  for (int i = 0; i <= static_cast<int>(MoveStatus::kNoRoom); ++i) {
    EXPECT_NE(to_string(static_cast<MoveStatus>(i)), "unknown status");
  }
}

TEST(PositionLimits, ChangeNothingWhereTheyAreNotMet) {
  for (int seed = 0; seed < problems(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 0.7);
    AxisMove free, move;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, free), MoveStatus::kSolved);
    const Extent extent = extent_of(free);
    r.limits.position_min = extent.low;
    r.limits.position_max = extent.high;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
    EXPECT_EQ(move.total, free.total);
    EXPECT_EQ(move.phases, free.phases);
    if (HasFailure()) return;
  }
}

/// Limits that were lowered: the start is outside, and may move outward still.
TEST(PositionLimits, LetAStartThatIsOutsideComeIn) {
  int solved = 0;
  for (int seed = 0; seed < problems(5000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 0.7);
    r.end.qd = r.end.qdd = 0.0;
    r.end.q = r.start.q - log_uniform(random, 1e-2, 10.0);
    r.limits.position_max = uniform(random, r.end.q, r.start.q);
    AxisMove move, stop;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
    ASSERT_EQ(quickest_velocity_change(r.start, {}, r.limits, stop), MoveStatus::kSolved);
    expect_connected(r, move);
    expect_limits(r, move);
    // No farther out than it needs to stop, and once inside it stays.
    EXPECT_LE(extent_of(move).high, extent_of(stop).high + 1e-9 * (r.start.q - r.end.q));
    bool inside = false;
    for (int i = 0; i <= 500; ++i) {
      const double q = move.at(move.total * i / 500.0).q;
      if (q < r.limits.position_max) inside = true;
      if (!inside) continue;
      EXPECT_LE(q, r.limits.position_max + 1e-9 * (r.start.q - r.end.q));
    }
    ++solved;
    if (HasFailure()) return;
  }
  EXPECT_EQ(solved, problems(5000));
}

/// Planned anew in every cycle from the law's own state, on the way to the wall itself and with a
/// speed limit that changes: the wall is never refused for rounding, and is arrived at exactly.
TEST(PositionLimits, AreArrivedAtWhenPlannedAnewInEveryCycle) {
  constexpr double kCycle = 0.002;
  for (int seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 0.5);
    r.start = {uniform(random, -1.0, 1.0), 0.0, 0.0, 0.0};
    r.limits.position_min = r.start.q - 1.0;
    r.limits.position_max = r.start.q + log_uniform(random, 0.1, 2.0);
    r.end = {r.limits.position_max, 0.0, 0.0, 0.0};
    const AxisLimits widest = r.limits;
    AxisMove move;
    for (int cycle = 0; cycle < 60000; ++cycle) {
      if (random() % 50 == 0) {
        r.limits.velocity_max = widest.velocity_max * log_uniform(random, 0.2, 1.0);
      }
      ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved)
          << "cycle " << cycle;
      r.start = move.at(kCycle);
      ASSERT_LE(r.start.q, r.limits.position_max + 1e-12);
      if (move.phases == 0) break;
    }
    EXPECT_EQ(r.start.q, r.end.q);
    EXPECT_EQ(r.start.qd, 0.0);
  }
}

}  // namespace
}  // namespace viapoint
