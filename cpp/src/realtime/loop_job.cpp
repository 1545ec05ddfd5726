#include "realtime/loop_job.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

constexpr double kNanosecond = 1e-9;
/// Waits longer than this are waits without end [s].
constexpr double kForever = 1e8;

/// p50, p99 and the largest of a figure of the log [s].
struct Spread {
  double p50 = 0.0, p99 = 0.0, max = 0.0;
};

Spread spread(const std::vector<LogRecord>& log, std::int64_t LogRecord::* figure) {
  if (log.empty()) return {};
  std::vector<std::int64_t> values;
  values.reserve(log.size());
  for (const LogRecord& record : log) values.push_back(record.*figure);
  std::ranges::sort(values);
  const auto at = [&](std::size_t percent) {
    return kNanosecond * static_cast<double>(values[(values.size() - 1) * percent / 100]);
  };
  return {at(50), at(99), at(100)};
}

}  // namespace

LoopJob::LoopJob(std::shared_ptr<const Trajectory> trajectory) {
  motion_.trajectory = std::move(trajectory);
}

bool LoopJob::wait(double timeout) {
  if (std::isnan(timeout)) {
    throw MotionError(ErrorCode::kBadArgument, "the time to wait is not a number");
  }
  std::unique_lock lock(mutex_);
  const auto is_over = [this] { return ended_; };
  if (timeout > kForever) {
    changed_.wait(lock, is_over);
  } else if (!changed_.wait_for(lock, std::chrono::duration<double>(std::max(timeout, 0.0)),
                                is_over)) {
    return false;
  }
  if (motion_.state == RunState::kFault) {
    Problem problem;
    problem.code = ErrorCode::kDriveFault;
    problem.message = fault_;
    problem.ways_out = {"clear the fault at the drive, then connect again"};
    problem.move = motion_.move;
    problem.time = motion_.nominal_time;
    throw MotionError(problem);
  }
  return true;
}

void LoopJob::wish(Wish wish) {
  Wish present = motion_.wish;
  while (present != Wish::kStop && !motion_.wish.compare_exchange_weak(present, wish)) {
  }
}

std::vector<LogRecord> LoopJob::log() const {
  const std::lock_guard lock(mutex_);
  return log_;
}

RunReport LoopJob::report() const {
  const std::vector<LogRecord> records = log();
  RunReport report;
  report.cycles = records.size() + motion_.lost_records;
  report.overruns = motion_.overruns;
  report.missed_cycles = motion_.missed_cycles;
  report.lost_records = motion_.lost_records;
  const Spread latency = spread(records, &LogRecord::latency);
  report.latency_p50 = latency.p50;
  report.latency_p99 = latency.p99;
  report.latency_max = latency.max;
  const Spread compute = spread(records, &LogRecord::compute);
  report.compute_p50 = compute.p50;
  report.compute_p99 = compute.p99;
  report.compute_max = compute.max;
  if (!records.empty()) {
    report.wall_time =
        kNanosecond * static_cast<double>(records.back().stamp - records.front().stamp);
  }
  return report;
}

bool LoopJob::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void LoopJob::append(std::span<const LogRecord> records) {
  const std::lock_guard lock(mutex_);
  log_.insert(log_.end(), records.begin(), records.end());
}

void LoopJob::end(std::string fault) {
  {
    const std::lock_guard lock(mutex_);
    fault_ = std::move(fault);
    ended_ = true;
  }
  changed_.notify_all();
}

}  // namespace viapoint
