#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "benches.hpp"
#include "json_line.hpp"
#include "realtime/random_motion.hpp"
#include "realtime/rate_path.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint::bench {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr double kSeconds = 2e-3;
/// Cycles with commands; then the motion is let go to its end.
constexpr std::size_t kCommanded = 1500;

struct Tally {
  std::uint64_t cycles = 0, backward = 0;
  double worst_share = 0.0;  ///< of any joint's velocity, acceleration or jerk, between cycles too
  double worst_deviation = 0.0;  ///< of any joint from the geometry at its nominal time [rad]
  int unfinished = 0;
};

void command(std::mt19937& random, Interpolator& interpolator) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  constexpr std::array kWishes = {Wish::kPause, Wish::kRun, Wish::kRun, Wish::kStep,
                                  Wish::kBackward};
  if (unit(random) < 0.4) return interpolator.set_override(unit(random));
  interpolator.wish(kWishes[static_cast<std::size_t>(unit(random) * 4.999)]);
}

void replay(unsigned seed, Tally& tally) {
  std::mt19937 random(seed);
  const Motion motion = random_motion(random);
  Interpolator interpolator(motion.limits, kCycle, motion.trajectory.at(0.0).q);
  interpolator.begin(motion.trajectory);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double eagerness = 0.002 + 0.1 * unit(random);
  std::vector<LogRecord> log;
  Setpoint setpoint;
  while (interpolator.active() && log.size() < 20 * kCommanded) {
    if (log.size() < kCommanded && unit(random) < eagerness) command(random, interpolator);
    if (log.size() == kCommanded) {
      interpolator.set_override(1.0);
      interpolator.wish(Wish::kRun);
    }
    interpolator.tick(setpoint);
    LogRecord& record = log.emplace_back();
    interpolator.describe(setpoint, record);
    tally.backward += record.rate < 0.0 ? 1 : 0;
    const JointVector there = motion.trajectory.at(record.nominal_time).q;
    tally.worst_deviation =
        std::max(tally.worst_deviation, (record.q - there).cwiseAbs().maxCoeff());
  }
  tally.cycles += log.size();
  tally.unfinished += interpolator.state() == RunState::kFinished ? 0 : 1;
  tally.worst_share = std::max(tally.worst_share, worst_shares(motion, log, kSeconds, 10).worst());
}

}  // namespace

void bench_commands(int sequences) {
  Tally tally;
  for (int seed = 0; seed < sequences; ++seed) replay(static_cast<unsigned>(seed), tally);
  JsonLine("commands", "at random")
      .add("sequences", sequences)
      .add("cycles", tally.cycles)
      .add("backward_cycles", tally.backward)
      .add("worst_deviation_rad", tally.worst_deviation)
      .add("worst_share_less_1", tally.worst_share - 1.0)
      .add("unfinished", tally.unfinished);
}

}  // namespace viapoint::bench
