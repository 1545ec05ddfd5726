/// @file
/// What is kept of a run, in bounded memory however long it lasts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "realtime/duration_histogram.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/motion_log.hpp"

namespace viapoint {

/// The newest records, and figures of all cycles that were appended. Of a rest on the path it keeps
/// the first two cycles: the set-point, and the cycle in which the drive has measured it.
/// Threads: one at a time. Real-time: not.
class RunLog {
 public:
  /// @param capacity records kept, > 0
  explicit RunLog(std::size_t capacity) : capacity_(capacity) {}

  void append(const LogRecord& record);
  [[nodiscard]] std::vector<LogRecord> records() const;
  /// At most `count` of them, from cycle `from` on. O(log records + count)
  [[nodiscard]] std::vector<LogRecord> records(std::uint64_t from, std::size_t count) const;
  /// Cycles, rested cycles, lost records, times and quantiles. O(1), whatever the run's length.
  [[nodiscard]] RunReport report() const;

 private:
  [[nodiscard]] bool rests_on(const LogRecord& record) const;

  std::size_t capacity_;
  /// A deque, so that no growth copies the log while the companion should be draining the ring.
  std::deque<LogRecord> records_;
  bool resting_ = false;  ///< the last record is the second of a rest
  std::uint64_t cycles_ = 0, rested_ = 0, dropped_ = 0;
  std::int64_t first_stamp_ = 0, last_stamp_ = 0;
  DurationHistogram latency_, compute_;
};

}  // namespace viapoint
