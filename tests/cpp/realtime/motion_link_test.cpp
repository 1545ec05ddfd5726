// Motions that get longer while they run: the path and the limits are kept, whatever is commanded.
#include "viapoint/realtime/motion_link.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "problem_count.hpp"
#include "realtime/motion_chain.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/realtime/guard.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};

/// The motion from piece `first` on.
Trajectory rest_of(const Motion& motion, std::size_t first) {
  const auto& pieces = motion.trajectory.pieces();
  return {{pieces.begin() + static_cast<std::ptrdiff_t>(first), pieces.end()},
          motion.limits,
          motion.trajectory.at(motion.trajectory.start_of(first))};
}

/// An arm on a motion that is handed over again and again from some piece on: it goes over to the
/// same motion each time, so that where it has to be is known.
struct Handover {
  explicit Handover(unsigned seed)
      : random(seed),
        motion(random_motion(random)),
        interpolator(motion.limits, kCycle, motion.trajectory.at(0.0).q),
        guard(motion.limits, kCycle, {}, motion.trajectory.at(0.0).q),
        chain(std::make_shared<Trajectory>(motion.trajectory), motion.limits) {
    interpolator.begin(motion.trajectory, true);
  }
  [[nodiscard]] bool chance(double share) {
    return std::uniform_real_distribution<double>(0.0, 1.0)(random) < share;
  }
  void command() {
    if (!chance(0.04)) return;
    if (chance(0.4)) {
      return interpolator.set_override(std::uniform_real_distribution<double>(0.0, 1.0)(random));
    }
    constexpr std::array kWishes = {Wish::kRun, Wish::kRun, Wish::kPause, Wish::kStep,
                                    Wish::kBackward};
    interpolator.wish(kWishes[random() % kWishes.size()]);
  }
  /// A link that begins with a piece to come, if there is one.
  void hand_over() {
    const Trajectory& whole = motion.trajectory;
    const std::size_t first = whole.piece_at(interpolator.nominal_time()) + 1 + random() % 3;
    if (link != nullptr || first >= whole.pieces().size()) return;
    const double leave = whole.start_of(first) - chain.last_start();
    if (leave <= 0.0) return;
    link = chain.lengthen(rest_of(motion, first), leave, interpolator.nominal_time());
  }
  void decide() {
    if (link == nullptr) return;
    const NoAllocationScope scope;
    const LinkFate fate = interpolator.lengthen(*link);
    allocations += scope.calls();
    if (fate == LinkFate::kNotYet) return;
    (fate == LinkFate::kTaken ? taken : missed) += 1;
    chain.settle(fate);
    link = nullptr;
  }

  std::mt19937 random;
  Motion motion;
  Interpolator interpolator;
  Guard guard;
  MotionChain chain;
  const MotionLink* link = nullptr;
  std::uint64_t allocations = 0;
  int taken = 0, missed = 0;
};

TEST(MotionLink, KeepsThePathAndTheLimitsWhateverIsCommanded) {
  int taken = 0, missed = 0, backward = 0;
  for (unsigned seed = 0; seed < problems(400U); ++seed) {
    SCOPED_TRACE(seed);
    Handover run(seed);
    Setpoint setpoint;
    for (int k = 0; k < 1500 && run.interpolator.active(); ++k) {
      if (k < 1000) {
        run.command();
      } else {
        run.interpolator.set_override(1.0);
        run.interpolator.wish(Wish::kRun);
        run.interpolator.close();
      }
      if (run.chance(0.1)) run.hand_over();
      run.decide();
      run.interpolator.tick(setpoint);
      backward += run.interpolator.rate() < 0.0 ? 1 : 0;
      const JointVector q = run.motion.trajectory.at(run.interpolator.nominal_time()).q;
      ASSERT_LE((q - setpoint.q).cwiseAbs().maxCoeff(), 1e-11) << "cycle " << k;
      ASSERT_EQ(run.guard.pass(setpoint), Guard::Verdict::kPass) << text_of(run.guard.breach());
    }
    ASSERT_EQ(run.allocations, 0U);
    taken += run.taken;
    missed += run.missed;
  }
  EXPECT_GT(taken, problems(400));
  EXPECT_GT(missed, problems(5));
  EXPECT_GT(backward, 1000);
}

TEST(MotionLink, EndsAtRestAndWaitsForMore) {
  Handover run(1);
  Setpoint setpoint;
  const Trajectory& whole = run.motion.trajectory;
  constexpr int kPatience = 100'000;
  for (int k = 0; k < kPatience && run.interpolator.state() != RunState::kWaiting; ++k) {
    run.interpolator.tick(setpoint);
  }
  ASSERT_EQ(run.interpolator.state(), RunState::kWaiting);
  EXPECT_EQ(setpoint.q, whole.at(whole.duration()).q);
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(run.interpolator.tick(setpoint), RunState::kWaiting);
    EXPECT_TRUE(setpoint.qd.isZero(0.0));
  }
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, setpoint.q, JointVector::Constant(setpoint.q.size(), 0.1),
                  run.motion.limits, 7);
  const MotionLink* link = run.chain.lengthen(Trajectory(pieces, run.motion.limits),
                                              whole.duration(), run.interpolator.nominal_time());
  ASSERT_EQ(run.interpolator.lengthen(*link), LinkFate::kTaken);
  run.chain.settle(LinkFate::kTaken);
  run.interpolator.close();
  Guard guard(run.motion.limits, kCycle, {}, setpoint.q);
  const JointVector goal = setpoint.q.array() + 0.1;
  for (int k = 0; k < kPatience && run.interpolator.active(); ++k) {
    run.interpolator.tick(setpoint);
    ASSERT_EQ(guard.pass(setpoint), Guard::Verdict::kPass);
  }
  EXPECT_EQ(run.interpolator.state(), RunState::kFinished);
  EXPECT_EQ(run.interpolator.move(), 7);
  EXPECT_TRUE(setpoint.q.isApprox(goal, 1e-12));
}

TEST(MotionLink, GoesOnFromRestWhereItComesInTheCycleOfTheEnd) {
  for (unsigned seed = 0; seed < 20U; ++seed) {
    SCOPED_TRACE(seed);
    Handover run(seed);
    const Trajectory& whole = run.motion.trajectory;
    Setpoint setpoint;
    for (int k = 0; k < 100'000 && run.interpolator.settled_time() < whole.duration(); ++k) {
      run.interpolator.tick(setpoint);
      ASSERT_EQ(run.guard.pass(setpoint), Guard::Verdict::kPass);
    }
    ASSERT_EQ(run.interpolator.state(), RunState::kRunning) << "its end comes next";
    const JointVector end = whole.at(whole.duration()).q;
    std::vector<TrajectoryPiece> pieces;
    append_straight(pieces, end, JointVector::Constant(end.size(), 0.1), run.motion.limits, 7);
    run.link = run.chain.lengthen(Trajectory(pieces, run.motion.limits), whole.duration(),
                                  run.interpolator.nominal_time());
    run.decide();
    ASSERT_EQ(run.taken, 1);
    run.interpolator.close();
    for (int k = 0; k < 100'000 && run.interpolator.active(); ++k) {
      run.interpolator.tick(setpoint);
      ASSERT_EQ(run.guard.pass(setpoint), Guard::Verdict::kPass) << text_of(run.guard.breach());
    }
    EXPECT_EQ(run.interpolator.state(), RunState::kFinished);
  }
}

/// A motion that does not begin at rest any more would end the way back at speed.
TEST(MotionLink, LeavesTheWayBackToAnArmThatIsAboutToGoBack) {
  int tried = 0;
  for (unsigned seed = 0; seed < 20U; ++seed) {
    SCOPED_TRACE(seed);
    Handover run(seed);
    const Trajectory& whole = run.motion.trajectory;
    Setpoint setpoint;
    const auto tick = [&] {
      run.interpolator.tick(setpoint);
      ASSERT_EQ(run.guard.pass(setpoint), Guard::Verdict::kPass) << text_of(run.guard.breach());
    };
    const double begin = whole.start_of(1);
    for (int k = 0; k < 1000 && run.interpolator.nominal_time() <= begin; ++k) tick();
    if (whole.at(begin).qd.isZero(1e-6)) continue;
    ++tried;
    const Trajectory later = whole.continued(1, whole.duration(), rest_of(run.motion, 0));
    const MotionLink link{&later, whole.duration(), begin, 1, false};
    run.interpolator.wish(Wish::kBackward);
    ASSERT_EQ(run.interpolator.lengthen(link), LinkFate::kNotYet);
    for (int k = 0; k < 1000 && run.interpolator.state() != RunState::kPaused; ++k) {
      tick();
      ASSERT_EQ(run.interpolator.lengthen(link), LinkFate::kNotYet);
    }
    ASSERT_EQ(run.interpolator.state(), RunState::kPaused);
    EXPECT_EQ(run.interpolator.nominal_time(), 0.0);
  }
  EXPECT_GT(tried, 3);
}

/// Two straight moves, of which the second comes when the arm rests at the end of the first.
struct TwoMoves {
  TwoMoves() {
    append_straight(pieces, JointVector::Zero(2), JointVector::Constant(2, 0.5), limits, 0);
    first = Trajectory(pieces, limits);
    append_straight(pieces, JointVector::Constant(2, 0.5), JointVector::Constant(2, 0.5), limits,
                    1);
    both = Trajectory(pieces, limits);
    interpolator.begin(first, true);
  }
  void tick(int cycles) {
    for (int k = 0; k < cycles; ++k) interpolator.tick(setpoint);
  }
  [[nodiscard]] LinkFate lengthen() {
    return interpolator.lengthen({&both, first.duration(), 0.0, 0, true});
  }

  JointLimits limits = even_limits(2, 2.0, 20.0, 200.0);
  std::vector<TrajectoryPiece> pieces;
  Trajectory first, both;
  Interpolator interpolator{limits, kCycle, JointVector::Zero(2)};
  Setpoint setpoint;
};

TEST(MotionLink, AStepThatEndsWhereMoreIsWaitedForPausesThereWithoutAPush) {
  TwoMoves run;
  run.interpolator.wish(Wish::kStep);
  run.tick(2000);
  ASSERT_EQ(run.interpolator.state(), RunState::kWaiting)
      << "whether the move goes on is not known";
  ASSERT_EQ(run.lengthen(), LinkFate::kTaken);
  for (int k = 0; k < 10; ++k) {
    run.tick(1);
    ASSERT_EQ(run.interpolator.state(), RunState::kPaused);
    ASSERT_TRUE(run.setpoint.qddd.isZero(0.0)) << "cycle " << k;
    ASSERT_TRUE(run.setpoint.q.isApproxToConstant(0.5, 1e-12));
  }
  run.interpolator.wish(Wish::kStep);
  run.interpolator.close();
  run.tick(2000);
  EXPECT_EQ(run.interpolator.state(), RunState::kFinished);
  EXPECT_TRUE(run.setpoint.q.isApproxToConstant(1.0, 1e-12));
}

TEST(MotionLink, IsFinishedAtItsEndWhenItIsClosedPausedOrNot) {
  for (const bool by_override : {false, true}) {
    TwoMoves run;
    run.tick(2000);
    ASSERT_EQ(run.interpolator.state(), RunState::kWaiting);
    if (by_override) {
      run.interpolator.set_override(0.0);
    } else {
      run.interpolator.wish(Wish::kPause);
    }
    run.tick(10);
    ASSERT_EQ(run.interpolator.state(), RunState::kPaused);
    run.interpolator.close();
    run.tick(1);
    EXPECT_EQ(run.interpolator.state(), RunState::kFinished);
    EXPECT_FALSE(run.interpolator.active());
  }
}

TEST(MotionLink, IsHeldBeforeItsEndByAnOverrideOfZeroAlsoWhenItIsClosed) {
  TwoMoves run;
  run.tick(50);
  run.interpolator.set_override(0.0);
  run.interpolator.close();
  run.tick(2000);
  ASSERT_EQ(run.interpolator.state(), RunState::kPaused);
  run.interpolator.set_override(0.01);
  run.tick(1);
  EXPECT_EQ(run.interpolator.state(), RunState::kRunning);
  run.tick(100'000);
  EXPECT_EQ(run.interpolator.state(), RunState::kFinished);
}

TEST(MotionLink, IsRefusedWhereItsProofDoesNotHold) {
  Handover run(3);
  std::vector<TrajectoryPiece> pieces;
  const JointVector away = run.motion.trajectory.at(0.0).q.array() + 0.3;
  append_straight(pieces, away, JointVector::Constant(away.size(), 0.1), run.motion.limits, 0);
  const Trajectory elsewhere(pieces, run.motion.limits);
  EXPECT_THROW(run.chain.lengthen(elsewhere, run.motion.trajectory.duration(), 0.0), MotionError);
  EXPECT_THROW(run.chain.lengthen(elsewhere, -1.0, 0.0), MotionError);
  EXPECT_THROW(run.chain.lengthen(elsewhere, 1e6, 0.0), MotionError);
  EXPECT_TRUE(run.chain.is_settled());
}

/// Outputs beyond are switched already, and the new way counts its pieces otherwise.
TEST(MotionLink, ComesTooLateForAnArmThatHasBeenBeyondAndCameBack) {
  int decided = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Handover cell(seed);
    if (cell.motion.trajectory.pieces().size() < 6) continue;
    cell.hand_over();
    ASSERT_NE(cell.link, nullptr);
    const double leave = cell.link->same_until;
    Setpoint setpoint;
    const auto tick_until = [&](const auto& is_there) {
      for (int k = 0; k < 5000 && !is_there(); ++k) cell.interpolator.tick(setpoint);
    };
    tick_until([&] { return cell.interpolator.nominal_time() > leave + 1e-3; });
    cell.interpolator.wish(Wish::kBackward);
    tick_until([&] { return cell.interpolator.nominal_time() < 0.5 * leave; });
    cell.interpolator.wish(Wish::kRun);
    LinkFate fate = LinkFate::kNotYet;
    tick_until([&] {
      fate = cell.interpolator.lengthen(*cell.link);
      return fate != LinkFate::kNotYet;
    });
    EXPECT_EQ(fate, LinkFate::kTooLate);
    decided += cell.interpolator.nominal_time() < leave ? 1 : 0;
  }
  EXPECT_GT(decided, 10) << "it was decided only when the arm was beyond again";
}

}  // namespace
}  // namespace viapoint
