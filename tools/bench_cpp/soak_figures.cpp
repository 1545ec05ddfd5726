#include "soak_figures.hpp"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>

#include "json_line.hpp"

namespace viapoint::bench {
namespace {

/// Of a share, as everywhere where limits are held.
constexpr double kSlack = 1e-6;
/// Farther than this from the path is off it [rad or m]: far below 1 µm at any tool.
constexpr double kOnPath = 1e-9;
/// A process that keeps nothing of its runs stays within it, whatever the allocator does [MB].
constexpr double kMostGrowth = 32.0;
constexpr std::uint64_t kTold = 10;  ///< problems in words

double largest_share(const JointVector& values, const JointVector& limits) {
  return values.cwiseAbs().cwiseQuotient(limits).maxCoeff();
}

/// After a jog in a pause: the arm is on its path again.
bool is_back(RunState state) { return state == RunState::kRunning || state == RunState::kWaiting; }

}  // namespace

void MicrosecondCounts::add(std::int64_t nanoseconds) {
  const auto whole = static_cast<std::size_t>(std::max<std::int64_t>(nanoseconds, 0) / 1000);
  ++counts_[std::min(whole, counts_.size() - 1)];
  ++total_;
  largest_ = std::max(largest_, nanoseconds);
}

double MicrosecondCounts::quantile_us(double share) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total_)));
  if (wanted >= total_) return static_cast<double>(largest_) / 1e3;
  std::uint64_t below = 0;
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    below += counts_[k];
    if (below >= wanted) return static_cast<double>(k);
  }
  return static_cast<double>(largest_) / 1e3;
}

std::uint64_t MicrosecondCounts::above_us(std::size_t bound) const {
  std::uint64_t count = 0;
  for (std::size_t k = bound; k < counts_.size(); ++k) count += counts_[k];
  return count;
}

void SoakFigures::note(const std::string& what) {
  if (++problems_ <= kTold) std::cerr << "soak: " << what << '\n';
}

void SoakFigures::note_memory() {
  malloc_trim(0);  // what the run before has left is no growth
  std::ifstream file("/proc/self/statm");
  double size = 0.0, resident = 0.0;
  file >> size >> resident;
  memory_.push_back(resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6);
}

void SoakFigures::judge(const Job& job, const Trajectory& way, bool stop_told) {
  const std::vector<LogRecord> log = job.log();
  const RunReport report = job.report();
  ++runs_;
  records_ += log.size();
  lost_ += report.lost_records;
  overruns_ += report.overruns;
  missed_ += report.missed_cycles;
  const RunState end = job.state();
  if (end == RunState::kFinished) {
    ++finished_;
  } else if (end == RunState::kStopped && stop_told) {
    ++stopped_;
  } else {
    note(std::string("a run ended ") + to_string(end));
  }
  bool is_off = false;
  const LogRecord* before = nullptr;
  for (const LogRecord& record : log) {
    hold(record, before);
    ++states_[static_cast<std::size_t>(record.state)];
    before = &record;
    if (record.state == RunState::kJogging) is_off = true;
    if (is_back(record.state)) is_off = false;
    if (is_off || record.q.size() != way.joints()) continue;
    const double off = (record.q - way.at(record.nominal_time).q).cwiseAbs().maxCoeff();
    worst_deviation_ = std::max(worst_deviation_, off);
    if (off <= kOnPath) continue;
    std::ostringstream text;
    text << "the arm was " << off << " off its path " << record.nominal_time << " s along it";
    note(text.str());
  }
}

/// The setpoint's own rates, and those that the drive sees from one setpoint to the next.
void SoakFigures::hold(const LogRecord& record, const LogRecord* before) {
  latency_.add(record.latency);
  compute_.add(record.compute);
  double share = std::max({largest_share(record.qd, limits_.velocity),
                           largest_share(record.qdd, limits_.acceleration),
                           largest_share(record.qddd, limits_.jerk)});
  if (before != nullptr && record.cycle == before->cycle + 1) {
    share = std::max({share, largest_share((record.q - before->q) / cycle_, limits_.velocity),
                      largest_share((record.qd - before->qd) / cycle_, limits_.acceleration),
                      largest_share((record.qdd - before->qdd) / cycle_, limits_.jerk)});
  }
  worst_share_ = std::max(worst_share_, share);
  if (share <= 1.0 + kSlack) return;
  std::ostringstream text;
  text << "a rate was " << share << " of its limit in cycle " << record.cycle << " of a run";
  note(text.str());
}

void SoakFigures::print(std::uint64_t cycles, double seconds) const {
  const double begin = memory_.empty() ? 0.0 : memory_.front();
  const double middle = memory_.empty() ? 0.0 : memory_[memory_.size() / 2];
  const double end = memory_.empty() ? 0.0 : memory_.back();
  std::uint64_t problems = problems_;
  if (end > middle + kMostGrowth) {
    std::cerr << "soak: memory has grown from " << middle << " to " << end << " MB\n";
    ++problems;
  }
  JsonLine("soak", "one arm, four threads")
      .add("minutes", seconds / 60.0)
      .add("cycles", cycles)
      .add("missed_cycles", missed_)
      .add("overruns", overruns_)
      .add("runs", runs_)
      .add("finished", finished_)
      .add("stopped", stopped_)
      .add("failures", problems);
  JsonLine("soak_motion", "all runs")
      .add("logged_cycles", records_)
      .add("lost_records", lost_)
      .add("worst_share_less_1", worst_share_ - 1.0)
      .add("worst_deviation_rad", worst_deviation_);
  JsonLine states("soak_states", "logged cycles");
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (states_[k] > 0) states.add(to_string(static_cast<RunState>(k)), states_[k]);
  }
  JsonLine("soak_memory", "resident MB").add("begin", begin).add("middle", middle).add("end", end);
  for (const auto& [name, counts] :
       {std::pair{"wake-up", &latency_}, std::pair{"computing", &compute_}}) {
    JsonLine("soak_times", name)
        .add("p50_us", counts->quantile_us(0.5))
        .add("p99_us", counts->quantile_us(0.99))
        .add("p99.9_us", counts->quantile_us(0.999))
        .add("max_us", counts->quantile_us(1.0))
        .add("later_than_200_us", counts->above_us(200))
        .add("later_than_2000_us", counts->above_us(2000));
  }
  JsonLine("soak_verdict", "failures").add("value", problems);
}

}  // namespace viapoint::bench
