// From rest to rest there are formulas of their own: what they give has to be the motion that the
// general solver finds, whatever the limits.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>

#include "profile/axis_move_checks.hpp"
#include "profile/state_judge.hpp"

namespace viapoint {
namespace {

using testing::AxisRequest;

constexpr int kProblems = 20'000;
/// Of a limit: the falling jerk goes through from one limit of the acceleration to the other, which
/// may be a millionth of it, and brings the rounding of the larger along.
constexpr double kHolds = 1e-9;

AxisRequest rest_request(testing::Dice& dice, double decades) {
  AxisRequest r;
  r.limits = testing::random_limits(dice, decades);
  if (dice.one_in(3)) r.limits.acceleration_min = -r.limits.acceleration_max;
  r.start.q = dice.one_in(2) ? dice.uniform(-1.0, 1.0) : 0.0;
  r.end.q = r.start.q + dice.sign() * dice.log_uniform(1e-3, 1e3);
  return r;
}

/// Which limits the motion holds, as a word.
std::string shape_of(const AxisRequest& r, const AxisMove& move) {
  const double sign = r.end.q > r.start.q ? 1.0 : -1.0;
  std::string shape;
  for (int i = 0; i < move.phases; ++i) {
    const AxisState& from = move.phase[static_cast<std::size_t>(i)].from;
    if (from.qddd != 0.0) continue;
    shape += from.qdd == 0.0 ? "c" : sign * from.qdd > 0.0 ? "a" : "d";
  }
  return shape;
}

TEST(RestMotion, LastsAsLongAsTheGeneralSolverFinds) {
  std::map<std::string, int> shapes;
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    testing::Dice dice(seed);
    AxisRequest r = rest_request(dice, 2.0);
    AxisMove move, general;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
    ++shapes[shape_of(r, move)];
    // A speed that is none, and yet not zero: too little to be seen in anything but the way taken.
    r.start.qd = dice.sign() * 1e-60;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, general), MoveStatus::kSolved);
    EXPECT_NEAR(move.total, general.total, 1e-12 * general.total);
    if (HasFailure()) return;
  }
  for (const char* shape : {"", "a", "d", "c", "ad", "ac", "cd", "acd"}) {
    EXPECT_GT(shapes[shape], 100) << "with holds \"" << shape << "\"";
  }
}

TEST(RestMotion, IsExactWithinLimitsAndExtremal) {
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    testing::Dice dice(seed);
    const AxisRequest r = rest_request(dice, 3.0);
    AxisMove move;
    ASSERT_EQ(quickest_move(r.start, r.end, r.limits, move), MoveStatus::kSolved);
    expect_connected(r, move);
    expect_limits(r, move);
    expect_extremal(r, move);
    if (HasFailure()) return;
  }
}

TEST(RestMotion, IsTheMirrorImageDownwards) {
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    testing::Dice dice(seed);
    const AxisRequest r = rest_request(dice, 2.0);
    const AxisLimits& l = r.limits;
    const AxisLimits turned{-l.velocity_max,     -l.velocity_min, -l.acceleration_max,
                            -l.acceleration_min, -l.jerk_max,     -l.jerk_min};
    AxisState from = r.start, to = r.end;
    from.q = -from.q;
    to.q = -to.q;
    AxisMove move, mirrored;
    ASSERT_EQ(quickest_move(r.start, r.end, l, move), MoveStatus::kSolved);
    ASSERT_EQ(quickest_move(from, to, turned, mirrored), MoveStatus::kSolved);
    ASSERT_EQ(move.phases, mirrored.phases);
    EXPECT_EQ(move.total, mirrored.total);
    for (std::size_t i = 0; i < static_cast<std::size_t>(move.phases); ++i) {
      EXPECT_EQ(move.phase[i].duration, mirrored.phase[i].duration);
      EXPECT_EQ(move.phase[i].from.q, -mirrored.phase[i].from.q);
      EXPECT_EQ(move.phase[i].from.qd, -mirrored.phase[i].from.qd);
    }
    if (HasFailure()) return;
  }
}

TEST(RestMotion, IsSlowedDownToAnyDurationForEverySynchronization) {
  for (std::uint64_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    testing::Dice dice(seed);
    testing::StateProblem problem;
    const int joints = 1 + static_cast<int>(dice.roll() % 4);
    for (int i = 0; i < joints; ++i) {
      const AxisRequest r = rest_request(dice, 3.0);
      problem.start.push_back(r.start);
      problem.end.push_back(r.end);
      if (dice.one_in(8)) problem.end.back().q = r.start.q;  // this one stays
      problem.limits.push_back(r.limits);
    }
    problem.options.synchronization =
        std::array{Synchronization::kTime, Synchronization::kLine,
                   Synchronization::kNone}[static_cast<std::size_t>(dice.roll() % 3)];
    StateToState motion, longer;
    ASSERT_EQ(motion.plan(problem.start, problem.end, problem.limits, problem.options),
              MoveStatus::kSolved);
    EXPECT_EQ(testing::judge(problem, motion).beyond(1e-10, kHolds), "");
    problem.options.least_duration = motion.duration() * dice.log_uniform(1.0, 10.0);
    ASSERT_EQ(longer.plan(problem.start, problem.end, problem.limits, problem.options),
              MoveStatus::kSolved);
    EXPECT_EQ(longer.duration(), problem.options.least_duration);
    EXPECT_EQ(testing::judge(problem, longer).beyond(1e-10, kHolds), "");
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace viapoint
