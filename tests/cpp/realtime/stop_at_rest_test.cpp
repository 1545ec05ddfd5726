// Stops that are left to the motion, where that rests as soon by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include "problem_count.hpp"
#include "realtime/random_motion.hpp"
#include "realtime/rate_path.hpp"
#include "realtime/ticking.hpp"
#include "viapoint/realtime/guard.hpp"
#include "viapoint/realtime/interpolator.hpp"
#include "viapoint/realtime/motion_link.hpp"

namespace viapoint {
namespace {

constexpr unsigned kMotions = problems(1000U);
constexpr int kMostCycles = 20'000;

/// Straight moves of two joints with a stop after each.
Motion moves_with_stops(std::mt19937& random, int moves) {
  Motion motion;
  motion.limits = even_limits(2, 2.0, 20.0, 200.0);
  std::vector<TrajectoryPiece> pieces;
  std::uniform_real_distribution<double> far(-1.0, 1.0);
  JointVector at = JointVector::Zero(2);
  for (int move = 0; move < moves; ++move) {
    const JointVector step{{far(random), far(random)}};
    append_straight(pieces, at, step, motion.limits, move);
    at += step;
  }
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

/// Where the move begins.
double start_of(const Trajectory& motion, int move) {
  std::size_t piece = 0;
  while (motion.pieces()[piece].move != move) ++piece;
  return motion.start_of(piece);
}

void run_to(Interpolator& interpolator, double nominal_time) {
  while (interpolator.nominal_time() < nominal_time) (void)tick(interpolator);
}
void run_to(Interpolator& interpolator, RunState state) {
  for (int k = 0; k < kMostCycles && interpolator.state() != state; ++k) (void)tick(interpolator);
}

/// Nominal times within the last pieces before the motion rests on its way, and those rests.
struct Approach {
  double from, rest;
};
std::vector<Approach> approaches(const Trajectory& motion) {
  std::vector<Approach> found;
  for (std::size_t i = 1; i + 1 < motion.pieces().size(); ++i) {
    const JointState end = motion.pieces()[i + 1].at(0.0);
    const bool moves = motion.pieces()[i].at(0.0).qdd.norm() > 1e-3;
    if (moves && end.qd.norm() < 1e-12 && end.qdd.norm() < 1e-12) {
      found.push_back({motion.start_of(i), motion.start_of(i + 1)});
    }
  }
  return found;
}

/// There the jerk brings the deceleration to nothing as quickly as it may: no stop is shorter.
TEST(StopAtARest, IsLeftToTheMotionWhereThatRestsAsSoonAsAStopCould) {
  int stopped = 0;
  for (unsigned seed = 0; seed < kMotions; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = straight_motion(random);
    for (const Approach& approach : approaches(motion.trajectory)) {
      const double share = std::uniform_real_distribution<double>(0.0, 1.0)(random);
      const double moment = approach.from + share * (approach.rest - approach.from);
      Interpolator interpolator = start(motion);
      std::vector<LogRecord> log;
      while (interpolator.nominal_time() < moment) log.push_back(tick(interpolator));
      const double begun = interpolator.nominal_time() + kSeconds;  // of the cycle to come
      if (begun > approach.rest - kSeconds) continue;
      interpolator.wish(Wish::kPause);
      while (interpolator.state() != RunState::kPaused && log.size() < kMostCycles) {
        log.push_back(tick(interpolator));
      }
      ++stopped;
      ASSERT_EQ(log.back().nominal_time, approach.rest);
      ASSERT_EQ(log.back().q, motion.trajectory.at(approach.rest).q);
      const auto paused = static_cast<double>(log.size() - 1) * kSeconds;
      ASSERT_LT(paused, approach.rest + kSeconds);
      // As if it had never been paused: it goes on at once, and outputs there come once.
      interpolator.wish(Wish::kRun);
      while (interpolator.active()) log.push_back(tick(interpolator));
      const auto whole = static_cast<double>(log.size() - 1) * kSeconds;
      ASSERT_LT(whole, motion.trajectory.duration() + 3.0 * kSeconds);
      ASSERT_LE(worst_shares(motion, log, kSeconds, 10).worst(), 1.0 + 1e-6);
    }
  }
  EXPECT_GT(stopped, static_cast<int>(kMotions / 2));
}

/// Far from where the motion rests a stop does not wait for it.
TEST(StopAtARest, ComesBeforeARestThatIsFarther) {
  Motion motion;
  motion.limits = even_limits(1, 2.0, 20.0, 200.0);
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(1), JointVector::Constant(1, 20.0), motion.limits, 0);
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  Interpolator interpolator = start(motion);
  run_to(interpolator, 0.5 * motion.trajectory.duration());
  const double begun = interpolator.nominal_time();
  interpolator.wish(Wish::kStop);
  run_to(interpolator, RunState::kStopped);
  EXPECT_LT(interpolator.nominal_time(), begun + 0.2);
}

/// Back from there and forward again, at the same place but at speed: nothing jumps.
TEST(StopAtARest, IsPassedAtSpeedLater) {
  for (unsigned seed = 0; seed < kMotions / 4; ++seed) {
    std::mt19937 random(seed);
    const Motion motion = moves_with_stops(random, 3);
    for (int back = 1; back < 40; ++back) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << back << " cycles back");
      Interpolator interpolator = start(motion);
      Guard guard(motion.limits, kCycle, {}, motion.trajectory.at(0.0).q);
      Setpoint setpoint;
      const auto guarded = [&] {
        interpolator.tick(setpoint);
        return guard.pass(setpoint) == Guard::Verdict::kPass;
      };
      while (interpolator.nominal_time() < start_of(motion.trajectory, 2) - 0.03) {
        ASSERT_TRUE(guarded());
      }
      interpolator.wish(Wish::kPause);
      while (interpolator.state() != RunState::kPaused) ASSERT_TRUE(guarded());
      interpolator.set_override(back % 2 == 0 ? std::ldexp(1.0, -(back % 5)) : 1.0);
      interpolator.wish(Wish::kBackward);
      for (int k = 0; k < back; ++k) ASSERT_TRUE(guarded());
      interpolator.wish(Wish::kRun);
      for (int k = 0; k < kMostCycles && interpolator.active(); ++k) {
        const double before = interpolator.nominal_time();
        ASSERT_TRUE(guarded());
        ASSERT_TRUE(interpolator.rate() <= 0.0 || interpolator.nominal_time() >= before - 1e-12);
      }
      ASSERT_EQ(interpolator.state(), RunState::kFinished);
    }
  }
}

/// On the way back, too; and a step from there is one.
TEST(StopAtARest, IsAPlaceToStepFromOnTheWayBack) {
  int rested = 0;
  for (unsigned seed = 0; seed < kMotions; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = moves_with_stops(random, 3);
    const double rest = start_of(motion.trajectory, 1);
    Interpolator interpolator = start(motion);
    run_to(interpolator, start_of(motion.trajectory, 2) - 0.1);
    interpolator.wish(Wish::kBackward);
    for (int k = 0; k < kMostCycles && interpolator.nominal_time() > rest + 0.03; ++k) {
      (void)tick(interpolator);
    }
    interpolator.wish(Wish::kPause);
    run_to(interpolator, RunState::kPaused);
    if (std::abs(interpolator.nominal_time() - rest) > 1e-9) continue;
    ++rested;
    interpolator.wish(Wish::kStep);
    (void)tick(interpolator);
    run_to(interpolator, RunState::kPaused);
    ASSERT_GT(interpolator.nominal_time(), rest + 0.01);
  }
  EXPECT_GT(rested, static_cast<int>(kMotions / 2));
}

/// Places of a motion whose beginning was left out are sums of other durations.
TEST(StopAtARest, IsThePlaceItselfAlsoWhereTheBeginningWasLeftOut) {
  int rested = 0;
  for (unsigned seed = 0; seed < kMotions; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = moves_with_stops(random, 8);
    const Trajectory& whole = motion.trajectory;
    const int passed = 1 + static_cast<int>(random() % 4);
    Interpolator interpolator = start(motion);
    run_to(interpolator, start_of(whole, passed));
    const std::size_t dropped = whole.piece_at(start_of(whole, passed));
    const std::size_t last = whole.piece_at(start_of(whole, 7));
    const double leave = whole.start_of(last);
    const Trajectory next(
        {whole.pieces().begin() + static_cast<std::ptrdiff_t>(last), whole.pieces().end()},
        motion.limits, whole.at(leave));
    const Trajectory shorter = whole.continued(dropped, leave, next);
    ASSERT_EQ(interpolator.lengthen({&shorter, leave, whole.start_of(dropped), dropped, true}),
              LinkFate::kTaken);
    const double rest = start_of(shorter, passed + 1);
    run_to(interpolator, whole.start_of(dropped) + rest - 0.03);
    interpolator.wish(Wish::kPause);
    run_to(interpolator, RunState::kPaused);
    if (std::abs(interpolator.nominal_time() - whole.start_of(dropped) - rest) > 1e-9) continue;
    ++rested;
    ASSERT_EQ(interpolator.move(), passed + 1);  // the place belongs to what comes next
    interpolator.wish(Wish::kStep);
    (void)tick(interpolator);
    run_to(interpolator, RunState::kPaused);
    ASSERT_GT(interpolator.nominal_time(), whole.start_of(dropped) + rest + 0.01);
  }
  EXPECT_GT(rested, static_cast<int>(kMotions / 2));
}

}  // namespace
}  // namespace viapoint
