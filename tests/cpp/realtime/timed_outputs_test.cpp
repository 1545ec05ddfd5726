// Outputs at places and times: every one comes once, when it is told, whatever is commanded.
#include "viapoint/realtime/timed_outputs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "problem_count.hpp"
#include "realtime/motion_chain.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "realtime/random_motion.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr double kSeconds = 2e-3;
constexpr double kSlack = 1e-7;

/// A change as it was told.
struct Told {
  double place = 0.0;  ///< nominal [s]
  double time = 0.0;   ///< [s]
  int output = 0;
  bool value = false;
};

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// The motion, cut at each place, with the changes on its pieces. @pre places rise
Trajectory with_changes(const Motion& motion, const std::vector<Told>& told) {
  std::vector<TrajectoryPiece> pieces;
  std::size_t next = 0;
  const auto& whole = motion.trajectory;
  for (std::size_t k = 0; k < whole.pieces().size(); ++k) {
    TrajectoryPiece rest = whole.pieces()[k];
    double begin = whole.start_of(k);
    for (; next < told.size() && told[next].place < whole.start_of(k) + whole.pieces()[k].duration;
         ++next) {
      const double tau = told[next].place - begin;
      if (tau > 0.0) {
        pieces.push_back(rest.until(tau));
        rest = rest.from(tau);
        begin += tau;
      }
      rest.output[static_cast<std::size_t>(rest.outputs++)] = {
          static_cast<std::int16_t>(told[next].output), told[next].value, told[next].time};
    }
    pieces.push_back(rest);
  }
  EXPECT_EQ(next, told.size());
  return {std::move(pieces), motion.limits};
}

/// Single changes of all kinds, and a train of pulses of output 0, at and after their places.
std::vector<Told> random_changes(std::mt19937& random, double duration) {
  std::vector<Told> told;
  for (int output = 1; output <= 12; ++output) {
    const double time = output % 3 == 0 ? 0.0 : uniform(random, -0.3, 0.3);
    told.push_back({uniform(random, 0.0, 0.999 * duration), time, output, true});
  }
  double due = 0.0;
  double place = 0.0;
  for (bool value = true; told.size() < 20;) {
    place += uniform(random, 0.01, 0.2) * duration;
    if (place >= 0.999 * duration) break;
    const double time = std::max(uniform(random, -0.1, 0.1), due + 0.01 - place);
    if (time < 0.0) continue;
    if (place + time > duration - 0.01) break;  // the end would bring several at once
    told.push_back({place, time, 0, std::exchange(value, !value)});
    due = place + time;
  }
  std::ranges::sort(told, {}, &Told::place);
  return told;
}

/// What a run has done, cycle by cycle, from the run's beginning.
struct Watched {
  std::vector<double> tau, farthest, rate;
  std::vector<std::uint64_t> outputs;
  std::vector<bool> pauses;

  void note(const Interpolator& interpolator, const Setpoint& setpoint, bool is_to_turn) {
    tau.push_back(interpolator.nominal_time());
    rate.push_back(interpolator.rate());
    farthest.push_back(farthest.empty() ? tau.back() : std::max(farthest.back(), tau.back()));
    outputs.push_back(setpoint.outputs);
    pauses.push_back(is_to_turn || interpolator.state() == RunState::kPausing);
  }
  [[nodiscard]] std::size_t last() const { return tau.size() - 1; }
  [[nodiscard]] bool is_on(std::size_t k, int output) const {
    return (outputs[k] >> output & 1U) != 0;
  }
  /// The cycle in which a change has come, the cycles before `from` left out.
  [[nodiscard]] std::optional<std::size_t> came(const Told& told, std::size_t from) const {
    for (std::size_t k = from; k <= last(); ++k) {
      if (is_on(k, told.output) == told.value) return k;
    }
    return std::nullopt;
  }
  [[nodiscard]] std::size_t passed(double place) const {
    const auto at = std::ranges::lower_bound(farthest, place - 1e-12);
    return std::min(last(), static_cast<std::size_t>(at - farthest.begin()));
  }
  /// When the place was passed on the clock [s], between two cycles as if at a constant rate.
  [[nodiscard]] double clock(double place) const {
    const std::size_t k = passed(place);
    if (k == 0) return 0.0;
    const double part = (place - farthest[k - 1]) / (farthest[k] - farthest[k - 1]);
    return (static_cast<double>(k - 1) + part) * kSeconds;
  }
  [[nodiscard]] bool is_steady(std::size_t from, std::size_t to) const {
    for (std::size_t k = from; k <= to; ++k) {
      // A pause, or a turn, may keep the rate until the path rests: beyond, nothing is due.
      if (rate[k] != rate[from] || rate[k] <= 0.0 || pauses[k]) return false;
    }
    return true;
  }
};

/// @returns how many were judged to a cycle
int judge(const Watched& run, const std::vector<Told>& told) {
  int exact = 0;
  std::array<std::size_t, kDigitalOutputs> from{};
  for (const Told& change : told) {
    SCOPED_TRACE(testing::Message() << "output " << change.output << " at " << change.place
                                    << " s, " << change.time << " s");
    auto& begin = from[static_cast<std::size_t>(change.output)];
    const std::optional<std::size_t> came = run.came(change, begin);
    if (!came) {
      ADD_FAILURE() << "lost";
      continue;
    }
    begin = *came;
    const double at = static_cast<double>(*came) * kSeconds;
    const std::size_t passed = run.passed(change.place);
    if (change.time == 0.0) {
      EXPECT_EQ(*came, passed);
      ++exact;
    } else if (change.time > 0.0) {
      const double due = run.clock(change.place) + change.time;
      EXPECT_TRUE(at >= due - kSlack || *came == run.last()) << at << " s, due " << due;
      EXPECT_LT(at, due + kSeconds + kSlack);
      ++exact;
    } else {
      EXPECT_LE(*came, passed);
      EXPECT_LE(change.place, run.tau[*came] - change.time + kSlack) << "no rate is that quick";
      // The last cycle ends where the motion does, however long it is.
      if (*came > 0 && run.farthest[passed] < run.farthest.back() &&
          run.is_steady(*came - 1, passed)) {
        const double due = run.clock(change.place) + change.time;
        EXPECT_GE(at, due - kSlack);
        EXPECT_LT(at, due + kSeconds + kSlack);
        ++exact;
      }
    }
  }
  for (int output = 0; output < kDigitalOutputs; ++output) {  // none comes twice
    const auto changes = std::ranges::count(told, output, &Told::output);
    std::ptrdiff_t seen = run.is_on(0, output) ? 1 : 0;
    for (std::size_t k = 1; k <= run.last(); ++k) {
      seen += run.is_on(k, output) != run.is_on(k - 1, output) ? 1 : 0;
    }
    EXPECT_EQ(seen, changes) << "output " << output;
  }
  return exact;
}

/// @param wish the last one
void command(Interpolator& interpolator, std::mt19937& random, Wish& wish) {
  if (uniform(random, 0.0, 1.0) > 0.02) return;
  if (uniform(random, 0.0, 1.0) < 0.4) {
    return interpolator.set_override(uniform(random, 0.0, 1.0));
  }
  constexpr std::array kWishes = {Wish::kRun, Wish::kRun, Wish::kPause, Wish::kBackward,
                                  Wish::kStep};
  wish = kWishes[random() % kWishes.size()];
  interpolator.wish(wish);
}

void go_on(Interpolator& interpolator, Wish& wish) {
  interpolator.set_override(1.0);
  wish = Wish::kRun;
  interpolator.wish(wish);
}

TEST(TimedOutputs, ComeOnceAndWhenTheyAreToldWhateverIsCommanded) {
  int exact = 0;
  for (unsigned seed = 0; seed < problems(500U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    const std::vector<Told> told = random_changes(random, motion.trajectory.duration());
    const Trajectory trajectory = with_changes(motion, told);
    Interpolator interpolator(motion.limits, kCycle, trajectory.at(0.0).q);
    interpolator.begin(trajectory);
    Watched run;
    Setpoint setpoint;
    std::uint64_t allocations = 0;
    Wish wish = Wish::kRun;
    for (int k = 0; interpolator.active(); ++k) {
      if (seed % 4 != 0) k < 1200 ? command(interpolator, random, wish) : go_on(interpolator, wish);
      const NoAllocationScope scope;
      interpolator.tick(setpoint);
      allocations += scope.calls();
      run.note(interpolator, setpoint, wish == Wish::kBackward);
    }
    ASSERT_EQ(allocations, 0U);
    exact += judge(run, told);
    if (HasFailure()) return;
  }
  EXPECT_GT(exact, static_cast<int>(problems(500U)) * 8);
}

TEST(TimedOutputs, AreTheSameWhenTheMotionIsHandedOverInParts) {
  int taken = 0;
  for (unsigned seed = 0; seed < problems(200U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    const std::vector<Told> told = random_changes(random, motion.trajectory.duration());
    const Trajectory whole = with_changes(motion, told);
    Interpolator interpolator(motion.limits, kCycle, whole.at(0.0).q);
    interpolator.begin(whole, true);
    MotionChain chain(std::make_shared<Trajectory>(whole), motion.limits);
    const MotionLink* link = nullptr;
    Watched run;
    Setpoint setpoint;
    Wish wish = Wish::kRun;
    for (int k = 0; interpolator.active(); ++k) {
      k < 1000 ? command(interpolator, random, wish) : go_on(interpolator, wish);
      if (k == 1000) interpolator.close();
      const double now = interpolator.nominal_time();
      const std::size_t first = whole.piece_at(now) + 1 + random() % 3;
      const double leave =
          first < whole.pieces().size() ? whole.start_of(first) - chain.last_start() : 0.0;
      if (link == nullptr && k < 1000 && random() % 10 == 0 && leave > 0.0) {
        const Trajectory next(
            {whole.pieces().begin() + static_cast<std::ptrdiff_t>(first), whole.pieces().end()},
            motion.limits, whole.at(whole.start_of(first)));
        link = chain.lengthen(next, leave, now);
      }
      if (link != nullptr) {
        const LinkFate fate = interpolator.lengthen(*link);
        taken += fate == LinkFate::kTaken ? 1 : 0;
        chain.settle(fate);
        if (fate != LinkFate::kNotYet) link = nullptr;
      }
      interpolator.tick(setpoint);
      run.note(interpolator, setpoint, wish == Wish::kBackward);
    }
    judge(run, told);
    if (HasFailure()) return;
  }
  EXPECT_GT(taken, static_cast<int>(problems(200U)) * 2);
}

/// One joint, 4 rad: about 2.1 s.
Motion one_move() {
  Motion motion;
  motion.limits = even_limits(1, 2.0, 20.0, 200.0);
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(1), JointVector::Constant(1, 4.0), motion.limits, 0);
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

TEST(TimedOutputs, GoOnWithTheClockInAPause) {
  const Motion motion = one_move();
  const Trajectory trajectory =
      with_changes(motion, {{0.5, 0.4, 1, true}, {0.501, -0.2, 2, true}, {1.0, -0.2, 3, true}});
  Interpolator interpolator(motion.limits, kCycle, trajectory.at(0.0).q);
  interpolator.begin(trajectory);
  Setpoint setpoint;
  while (interpolator.nominal_time() < 0.52) interpolator.tick(setpoint);
  EXPECT_EQ(setpoint.outputs, 1U << 2);
  interpolator.wish(Wish::kPause);
  int cycles = 0;
  for (; setpoint.outputs == 1U << 2 && cycles < 1000; ++cycles) interpolator.tick(setpoint);
  EXPECT_EQ(interpolator.state(), RunState::kPaused);
  EXPECT_NEAR(cycles * kSeconds, 0.38, 2.0 * kSeconds);
  for (int k = 0; k < 1000; ++k) interpolator.tick(setpoint);
  EXPECT_EQ(setpoint.outputs, 6U) << "the third place does not come nearer";
}

TEST(TimedOutputs, ComeWithTheEndAtTheLatest) {
  const Motion motion = one_move();
  const double end = motion.trajectory.duration();
  const Trajectory trajectory =
      with_changes(motion, {{end - 0.3, 0.2, 5, true}, {end - 0.1, 0.5, 5, false}});
  Interpolator interpolator(motion.limits, kCycle, trajectory.at(0.0).q);
  interpolator.begin(trajectory);
  Setpoint setpoint;
  bool was_on = false;
  while (interpolator.active()) {
    interpolator.tick(setpoint);
    was_on = was_on || setpoint.outputs == 1U << 5;
  }
  EXPECT_TRUE(was_on);
  EXPECT_EQ(setpoint.outputs, 0U);
}

TEST(TimedOutputs, AreRefusedATimeThatIsOutOfRange) {
  const Motion motion = one_move();
  for (const double time : {kMostOutputTime + 0.1, -kMostOutputTime - 0.1, std::nan("")}) {
    std::vector<TrajectoryPiece> pieces = motion.trajectory.pieces();
    pieces[0].outputs = 1;
    pieces[0].output[0] = {1, true, time};
    EXPECT_THROW(Trajectory(pieces, motion.limits), MotionError) << time;
  }
}

}  // namespace
}  // namespace viapoint
