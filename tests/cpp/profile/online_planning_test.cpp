// Planned anew in every cycle, from where the last plan is by then, under limits that change.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "profile/axis_move_checks.hpp"

namespace viapoint {
namespace {

using testing::AxisRequest;
using testing::log_uniform;
using testing::uniform;

constexpr double kCycle = 0.002;

TEST(OnlinePlanning, KeepsLimitsThatChangeInEveryCycle) {
  for (int seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 0.5);
    r.start = r.end = {};
    const AxisLimits widest = r.limits;
    AxisMove move;
    for (int cycle = 0; cycle < 20000; ++cycle) {
      if (cycle < 2000) {
        const auto vary = [&](double limit) { return limit * log_uniform(random, 0.2, 1.0); };
        r.limits = {vary(widest.velocity_min),     vary(widest.velocity_max),
                    vary(widest.acceleration_min), vary(widest.acceleration_max),
                    vary(widest.jerk_min),         vary(widest.jerk_max)};
        if (random() % 20 == 0) r.end.q = uniform(random, -1.0, 1.0);
      }
      ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
      const AxisState next = move.at(kCycle);
      const AxisLimits& l = r.limits;
      const auto& s = r.start;
      // Beyond a limit only where the start is, or where its acceleration cannot go fast enough.
      const double high = s.qd + (s.qdd > 0.0 ? -0.5 * s.qdd * s.qdd / l.jerk_min : 0.0);
      const double low = s.qd - (s.qdd < 0.0 ? 0.5 * s.qdd * s.qdd / l.jerk_max : 0.0);
      EXPECT_LE(next.qd, std::max(l.velocity_max, high) + 1e-9);
      EXPECT_GE(next.qd, std::min(l.velocity_min, low) - 1e-9);
      EXPECT_LE(next.qdd, std::max(l.acceleration_max, s.qdd) + 1e-9);
      EXPECT_GE(next.qdd, std::min(l.acceleration_min, s.qdd) - 1e-9);
      EXPECT_LE(next.qdd - s.qdd, l.jerk_max * kCycle + 1e-9);
      EXPECT_GE(next.qdd - s.qdd, l.jerk_min * kCycle - 1e-9);
      if (HasFailure()) FAIL() << "cycle " << cycle;
      r.start = next;
      if (cycle >= 2000 && move.phases == 0) break;
    }
    EXPECT_EQ(move.phases, 0);
    EXPECT_EQ(r.start.q, r.end.q);
    EXPECT_EQ(r.start.qd, 0.0);
  }
}

TEST(OnlinePlanning, DoesNotTurnBackWhereTheSpeedLimitFallsAndRises) {
  for (int seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 0.5);
    r.start = {};
    const double fastest = r.limits.velocity_max;
    r.end = {10.0 * fastest, 0.0, 0.0, 0.0};
    AxisMove move;
    bool arrives = false;
    for (int cycle = 0; cycle < 100000 && !arrives; ++cycle) {
      if (random() % 30 == 0) r.limits.velocity_max = fastest * log_uniform(random, 0.05, 1.0);
      ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
      r.start = move.at(kCycle);
      ASSERT_GE(r.start.qd, -1e-9) << "cycle " << cycle;
      ASSERT_LE(r.start.q, r.end.q + 1e-9) << "cycle " << cycle;
      arrives = move.phases == 0;
    }
    EXPECT_TRUE(arrives);
    EXPECT_EQ(r.start.q, r.end.q);
  }
}

}  // namespace
}  // namespace viapoint
