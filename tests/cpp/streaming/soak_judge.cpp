#include "streaming/soak_judge.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "realtime/rate_path.hpp"

namespace viapoint {
namespace {

/// Slack of a share, as everywhere where the limits are held.
constexpr double kSlack = 1e-6;
/// Farther than this from the path is off it [rad or m]: far below 1 µm at any tool.
constexpr double kOnPath = 1e-9;
/// A motion ends this little after its last cycle with it [s].
constexpr double kEndSlack = 1e-9;
/// Points of each cycle that its rates are looked at.
constexpr int kSamples = 3;

double largest_share(const JointVector& values, const JointVector& limits) {
  return values.cwiseAbs().cwiseQuotient(limits).maxCoeff();
}

/// After a jog in a pause: the arm is on its path again.
bool is_back(RunState state) { return state == RunState::kRunning || state == RunState::kWaiting; }

}  // namespace

SoakJudge::SoakJudge(JointLimits limits, double cycle, const StateTable& table)
    : limits_(std::move(limits)), cycle_(cycle), table_(table) {}

std::uint64_t SoakJudge::seen(RunState state) const {
  const auto found = seen_.find(state);
  return found == seen_.end() ? 0 : found->second;
}

void SoakJudge::note(const std::string& what) {
  if (problem_.empty()) problem_ = "cycle " + std::to_string(cycles_) + ": " + what;
}

void SoakJudge::see(const Setpoint& setpoint, RunState state, std::optional<Progress> progress) {
  const std::string from = to_string(last_state_), to = to_string(state);
  if (!table_.allows(from, to)) note(from + " became " + to);
  last_state_ = state;
  ++seen_[state];
  hold_limits(setpoint);
  last_ = setpoint;
  if (progress) {
    run_.push_back({state, *progress, setpoint.outputs, setpoint.q});
  } else if (run_.empty()) {
    outputs_before_ = setpoint.outputs;
  }
  ++cycles_;
}

/// The setpoint's own rates, and those that the drive sees from one setpoint to the next.
void SoakJudge::hold_limits(const Setpoint& setpoint) {
  double share = std::max({largest_share(setpoint.qd, limits_.velocity),
                           largest_share(setpoint.qdd, limits_.acceleration),
                           largest_share(setpoint.qddd, limits_.jerk)});
  if (cycles_ > 0) {
    share = std::max({share, largest_share((setpoint.q - last_.q) / cycle_, limits_.velocity),
                      largest_share((setpoint.qd - last_.qd) / cycle_, limits_.acceleration),
                      largest_share((setpoint.qdd - last_.qdd) / cycle_, limits_.jerk)});
  }
  worst_share_ = std::max(worst_share_, share);
  std::ostringstream text;
  if (!(share <= 1.0 + kSlack)) text << "a rate is " << share << " of its limit";
  const bool is_within = (setpoint.q.array() >= limits_.position_min.array() - kOnPath).all() &&
                         (setpoint.q.array() <= limits_.position_max.array() + kOnPath).all();
  if (!is_within) text << "a joint is beyond its position limit";
  if (!text.str().empty()) note(text.str());
}

void SoakJudge::judge_run(std::span<const Trajectory> ways, const std::vector<LogRecord>& log,
                          bool stop_told) {
  if (run_.empty()) return note("a run ended that was never seen");
  const RunState end = run_.back().state;
  if (end != RunState::kFinished && !(stop_told && end == RunState::kStopped)) {
    note(std::string("a run ended ") + to_string(end));
  }
  const JointVector goal = ways.back().at(ways.back().duration()).q;
  if (end == RunState::kFinished && (run_.back().q - goal).cwiseAbs().maxCoeff() > kOnPath) {
    note("a run finished elsewhere than at its end");
  }
  hold_path(ways);
  hold_outputs(ways);
  hold_rates(ways, log);
  outputs_before_ = run_.back().outputs;
  run_.clear();
  last_state_ = RunState::kIdle;
}

void SoakJudge::hold_path(std::span<const Trajectory> ways) {
  bool is_off = false;  // jogged away in a pause, and not yet back
  for (const Cycle& cycle : run_) {
    if (cycle.state == RunState::kJogging) is_off = true;
    if (is_back(cycle.state)) is_off = false;
    if (is_off) continue;
    const auto& [nominal_time, way] = cycle.progress;
    const double off = (cycle.q - ways[way].at(nominal_time).q).cwiseAbs().maxCoeff();
    worst_deviation_ = std::max(worst_deviation_, off);
    if (!(off <= kOnPath)) {
      std::ostringstream text;
      text << "the arm was " << off << " off its path at " << nominal_time << " s of it";
      return note(text.str());
    }
  }
}

/// Outputs are those of the farthest place that was reached, whatever happened on the way.
void SoakJudge::hold_outputs(std::span<const Trajectory> ways) {
  double farthest = 0.0;
  std::size_t farthest_way = 0;
  for (const Cycle& cycle : run_) {
    const auto& [nominal_time, way] = cycle.progress;
    if (nominal_time > farthest) {
      farthest = nominal_time;
      farthest_way = way;
    }
    const auto after = [&](double time) {
      const OutputEffect& effect = ways[way].outputs_after(ways[way].piece_at(time));
      return (outputs_before_ & ~effect.changed) | effect.on;
    };
    const std::uint64_t expected = after(farthest);
    // Where a step ends the arm is at the next piece's beginning, but for rounding.
    if (cycle.outputs == expected || cycle.outputs == after(farthest + kEndSlack)) continue;
    // What has been told only since the arm was at the end, and went back, waits for it there.
    if (farthest_way != way && cycle.outputs == after(farthest - kEndSlack)) continue;
    std::ostringstream text;
    text << "the outputs were " << cycle.outputs << " and not " << expected << " at "
         << nominal_time << " s, after " << farthest << " s";
    return note(text.str());
  }
}

/// Between the cycles, by the rate that each cycle's record tells.
void SoakJudge::hold_rates(std::span<const Trajectory> ways, const std::vector<LogRecord>& log) {
  std::vector<LogRecord> stretch;
  std::size_t way = 0;
  const auto judge = [&] {
    const Shares shares = worst_shares({limits_, ways[way]}, stretch, cycle_, kSamples);
    worst_share_ = std::max(worst_share_, shares.worst());
    if (!(shares.worst() <= 1.0 + kSlack)) {
      std::ostringstream text;
      text << "a rate is " << shares.worst() << " of its limit after cycle "
           << stretch[shares.cycle].cycle << " of the run";
      note(text.str());
    }
    stretch.clear();
  };
  bool is_off = false;
  for (const LogRecord& record : log) {
    if (record.state == RunState::kJogging) is_off = true;
    if (is_back(record.state)) is_off = false;
    if (is_off) {
      judge();
      continue;
    }
    // A rest leaves two records; the cycle before the arm goes on is like them.
    if (!stretch.empty() && record.cycle > stretch.back().cycle + 1) {
      stretch.push_back(stretch.back());
      stretch.back().cycle = record.cycle - 1;
    }
    // Where the way gets longer both are the same.
    const std::size_t follows =
        run_[std::min<std::size_t>(record.cycle, run_.size() - 1)].progress.way;
    if (follows != way && !stretch.empty()) {
      const LogRecord last = stretch.back();
      judge();
      stretch.push_back(last);
    }
    way = follows;
    stretch.push_back(record);
    // Chunks add up to the end but for rounding.
    if (record.nominal_time > ways[way].duration() - kEndSlack) {
      stretch.back().nominal_time = ways[way].duration();
    }
  }
  judge();
}

}  // namespace viapoint
