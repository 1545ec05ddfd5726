// Planned anew in every cycle, from where the last plan is by then, under limits that change.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "problem_count.hpp"
#include "profile/axis_move_checks.hpp"
#include "viapoint/profile/state_to_state.hpp"

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

/// Within its first `seconds` the motion keeps all limits, but for what the start is beyond them or
/// its acceleration takes it beyond. At the exact extremes, not at the ends.
void expect_limits_until(double seconds, const AxisRequest& r, const AxisMove& move) {
  const AxisLimits& l = r.limits;
  const AxisState& s = r.start;
  const double high = s.qd + (s.qdd > 0.0 ? -0.5 * s.qdd * s.qdd / l.jerk_min : 0.0);
  const double low = s.qd - (s.qdd < 0.0 ? 0.5 * s.qdd * s.qdd / l.jerk_max : 0.0);
  double begin = 0.0;
  for (int i = 0; i < move.phases && begin < seconds; ++i) {
    const auto& [duration, from] = move.phase[static_cast<size_t>(i)];
    const double end = std::min(duration, seconds - begin);
    const double peak = from.qddd != 0.0 ? std::clamp(-from.qdd / from.qddd, 0.0, end) : 0.0;
    EXPECT_LE(from.qddd, l.jerk_max * (1.0 + 1e-15));
    EXPECT_GE(from.qddd, l.jerk_min * (1.0 + 1e-15));
    for (const double t : {0.0, peak, end}) {
      const double qd = from.qd + t * (from.qdd + 0.5 * from.qddd * t);
      const double qdd = from.qdd + t * from.qddd;
      EXPECT_LE(qd, std::max(l.velocity_max, high) + 1e-12 * (1.0 + std::abs(high)));
      EXPECT_GE(qd, std::min(l.velocity_min, low) - 1e-12 * (1.0 + std::abs(low)));
      EXPECT_LE(qdd, std::max(l.acceleration_max, s.qdd) + 1e-12 * (1.0 + std::abs(s.qdd)));
      EXPECT_GE(qdd, std::min(l.acceleration_min, s.qdd) - 1e-12 * (1.0 + std::abs(s.qdd)));
    }
    begin += duration;
  }
}

TEST(OnlinePlanning, KeepsEveryLimitWhileTargetAndLimitsChangeInEveryCycle) {
  for (int seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::vector<AxisState> start(3), end(3);
    std::vector<AxisLimits> widest, limits;
    for (int i = 0; i < 3; ++i) widest.push_back(testing::random_request(random, 0.5).limits);
    StateToStateOptions options;
    if (seed % 2 == 1) options.synchronization = Synchronization::kNone;
    const double noise = seed % 3 == 0 ? 0.0 : log_uniform(random, 1e-9, 1e-2);
    StateToState motion;
    for (int cycle = 0; cycle < 1500; ++cycle) {
      limits = widest;
      for (size_t i = 0; i < 3; ++i) {
        AxisLimits& l = limits[i];
        for (double* limit : {&l.velocity_min, &l.velocity_max, &l.acceleration_min,
                              &l.acceleration_max, &l.jerk_min, &l.jerk_max}) {
          *limit *= log_uniform(random, 0.2, 1.0);
        }
        // A wave that is faster than the joints, or noise on a target that rests.
        const double wave =
            seed % 3 == 0 ? std::sin(0.01 * cycle * static_cast<double>(i + 1)) : 0.5;
        end[i].q = wave + noise * uniform(random, -1.0, 1.0);
      }
      ASSERT_EQ(motion.plan(start, end, limits, options), MoveStatus::kSolved);
      for (size_t i = 0; i < 3; ++i) {
        const AxisMove& move = motion.axis(static_cast<int>(i));
        expect_limits_until(kCycle, {start[i], end[i], limits[i]}, move);
        start[i] = move.at(kCycle);
      }
      if (HasFailure()) FAIL() << "cycle " << cycle;
    }
  }
}

/// How often the velocity changes its sign, that of rest aside.
class Reversals {
 public:
  void see(double qd) {
    if (qd * last_ < 0.0) ++count_;
    if (qd != 0.0) last_ = qd;
  }
  [[nodiscard]] int count() const { return count_; }

 private:
  double last_ = 0.0;
  int count_ = 0;
};

TEST(OnlinePlanning, ArrivesAtARestingTargetAsTheFirstPlanWouldHave) {
  for (int seed = 0; seed < problems(400); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    AxisRequest r = testing::random_request(random, 0.5);
    r.end.qd = r.end.qdd = 0.0;
    AxisMove first, move;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, first), MoveStatus::kSolved);
    Reversals planned, gone;
    for (int i = 0; i < first.phases; ++i) {
      const auto& [duration, from] = first.phase[static_cast<size_t>(i)];
      const double peak = from.qddd != 0.0 ? std::clamp(-from.qdd / from.qddd, 0.0, duration) : 0.0;
      for (const double t : {0.0, peak, duration}) {
        const double qd = from.qd + t * (from.qdd + 0.5 * from.qddd * t);
        if (std::abs(qd) > 1e-12) planned.see(qd);
      }
    }
    const AxisMove::Extent extent = first.extent();
    const double size = extent.high - extent.low;
    int cycle = 0;
    for (; cycle < 100'000; ++cycle) {
      ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
      if (move.phases == 0) break;
      r.start = move.at(kCycle);
      if (std::abs(r.start.qd) > 1e-9 * size) gone.see(r.start.qd);
      ASSERT_LE(r.start.q, extent.high + 1e-9 * size) << "cycle " << cycle;
      ASSERT_GE(r.start.q, extent.low - 1e-9 * size) << "cycle " << cycle;
    }
    EXPECT_LE(gone.count(), planned.count());
    EXPECT_LE(cycle, static_cast<int>(std::ceil(first.total / kCycle)) + 2);
    EXPECT_EQ(r.start.q, r.end.q);
    EXPECT_EQ(r.start.qd, 0.0);
    EXPECT_EQ(r.start.qdd, 0.0);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace viapoint
