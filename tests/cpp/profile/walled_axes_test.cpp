// Position limits during the motion of several axes together.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "problem_count.hpp"
#include "profile/axis_move_checks.hpp"
#include "profile/walled_moves.hpp"
#include "viapoint/profile/state_to_state.hpp"

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
using testing::random_walled_request;
using testing::uniform;

TEST(PositionLimits, HoldForEverySynchronizationAndDuration) {
  int planned = 0, as_asked = 0;
  for (int seed = 0; seed < problems(10000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::vector<AxisRequest> all;
    const size_t axes = 1 + random() % 3;
    double slowest = 0.0;
    for (size_t i = 0; i < axes; ++i) {
      AxisRequest r = i == 0 ? random_walled_request(random) : testing::random_request(random, 0.7);
      if (i == 0 && random() % 2 == 0) {  // one that can rest at its end
        r.end.qd = r.end.qdd = 0.0;
        AxisMove move;
        if (quickest_move(r.start, r.end, r.limits, move) != MoveStatus::kSolved) {
          r = random_walled_request(random);
        }
      }
      AxisMove move;
      ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
      slowest = std::max(slowest, move.total);
      all.push_back(r);
    }
    std::vector<AxisState> start, end;
    std::vector<AxisLimits> limits;
    for (const AxisRequest& r : all) {
      start.push_back(r.start);
      end.push_back(r.end);
      limits.push_back(r.limits);
    }
    StateToStateOptions options;
    options.synchronization = random() % 4 == 0 ? Synchronization::kNone : Synchronization::kTime;
    if (random() % 2 == 0) options.least_duration = slowest * uniform(random, 1.0, 2.5);
    if (random() % 3 == 0) options.cycle = 0.004;
    StateToState motion;
    const MoveStatus status = motion.plan(start, end, limits, options);
    // Where an axis is too fast to rest between its walls it cannot wait for the others.
    if (status == MoveStatus::kDurationImpossible) continue;
    ASSERT_EQ(status, MoveStatus::kSolved);
    ++planned;
    const double wanted = std::max(slowest, options.least_duration);
    if (motion.duration() <= wanted + options.cycle) ++as_asked;
    for (size_t i = 0; i < axes; ++i) {
      SCOPED_TRACE("axis " + std::to_string(i));
      const AxisMove& move = motion.axis(static_cast<int>(i));
      expect_connected(all[i], move);
      expect_limits(all[i], move);
      expect_inside(limits[i], move);
      if (options.synchronization == Synchronization::kTime) {
        EXPECT_EQ(move.total, motion.duration());
      }
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(planned, problems(9900));
  EXPECT_GT(as_asked, problems(8500));
}

TEST(PositionLimits, HoldAlongALine) {
  StateToStateOptions options;
  options.synchronization = Synchronization::kLine;
  StateToState motion;
  int turned = 0;
  for (int seed = 0; seed < problems(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const AxisRequest r = random_walled_request(random);
    std::vector<AxisState> start, end;
    std::vector<AxisLimits> limits;
    for (const double factor : {1.0, -0.5, 0.0}) {
      const auto scaled = [&](const AxisState& s) {
        return AxisState{7.0 + factor * s.q, factor * s.qd, factor * s.qdd, 0.0};
      };
      start.push_back(scaled(r.start));
      end.push_back(scaled(r.end));
      limits.push_back(AxisLimits::symmetric(1e3, 1e3, 1e3));
    }
    limits[0] = r.limits;
    limits[0].position_min = -kNone;
    limits[0].position_max += 7.0;
    limits[1].position_max =
        7.0 - 0.5 * r.limits.position_min;  // the lower wall, by the other axis
    const MoveStatus status = motion.plan(start, end, limits, options);
    ASSERT_EQ(status, MoveStatus::kSolved) << to_string(status);
    AxisMove alone;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, alone), MoveStatus::kSolved);
    EXPECT_NEAR(motion.duration(), alone.total, 1e-5 * alone.total);
    for (size_t i = 0; i < 3; ++i) {
      const AxisMove& move = motion.axis(static_cast<int>(i));
      const Extent extent = extent_of(move);
      EXPECT_LE(extent.high, limits[i].position_max + 1e-8);
      EXPECT_GE(extent.low, limits[i].position_min - 1e-8);
    }
    if (extent_of(motion.axis(0)).high > std::max(start[0].q, end[0].q) + 1e-6) ++turned;
    if (HasFailure()) return;
  }
  EXPECT_GT(turned, problems(500));
  // A joint outside its limits that the line does not move never comes in.
  std::vector<AxisState> start(2), end(2);
  end[0].q = 1.0;
  const std::vector<AxisLimits> limits{between(-2.0, 2.0), between(1.0, 2.0)};
  EXPECT_EQ(motion.plan(start, end, limits, options), MoveStatus::kEndPosition);
  EXPECT_EQ(motion.culprit(), 1);
}

}  // namespace
}  // namespace viapoint
