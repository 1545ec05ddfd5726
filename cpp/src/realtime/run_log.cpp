#include "realtime/run_log.hpp"

#include <algorithm>

namespace viapoint {
namespace {

constexpr double kNanosecond = 1e-9;

}  // namespace

void RunLog::append(const LogRecord& record) {
  if (cycles_++ == 0) first_stamp_ = record.stamp;
  last_stamp_ = record.stamp;
  latency_.add(record.latency);
  compute_.add(record.compute);
  const bool rests = rests_on(record);
  if (rests && resting_) {
    ++rested_;
    return;
  }
  resting_ = rests;
  if (records_.size() == capacity_) {
    records_.pop_front();
    ++dropped_;
  }
  records_.push_back(record);
}

bool RunLog::rests_on(const LogRecord& record) const {
  if (record.state != RunState::kPaused && record.state != RunState::kWaiting) return false;
  if (records_.empty()) return false;
  const LogRecord& last = records_.back();
  return last.state == record.state && last.outputs == record.outputs && last.q == record.q;
}

std::vector<LogRecord> RunLog::records() const { return {records_.begin(), records_.end()}; }

std::vector<LogRecord> RunLog::records(std::uint64_t from, std::size_t count) const {
  const auto first = std::lower_bound(
      records_.begin(), records_.end(), from,
      [](const LogRecord& record, std::uint64_t cycle) { return record.cycle < cycle; });
  const auto left = static_cast<std::size_t>(records_.end() - first);
  return {first, first + static_cast<std::ptrdiff_t>(std::min(count, left))};
}

RunReport RunLog::report() const {
  RunReport report;
  report.cycles = cycles_;
  report.rested_cycles = rested_;
  report.lost_records = dropped_;
  report.wall_time = kNanosecond * static_cast<double>(last_stamp_ - first_stamp_);
  report.latency_p50 = latency_.quantile(50);
  report.latency_p99 = latency_.quantile(99);
  report.latency_max = latency_.quantile(100);
  report.compute_p50 = compute_.quantile(50);
  report.compute_p99 = compute_.quantile(99);
  report.compute_max = compute_.quantile(100);
  return report;
}

}  // namespace viapoint
