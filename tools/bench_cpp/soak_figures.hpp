/// @file
/// What a soak counts, and what it finds wrong.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint::bench {

/// Durations counted by the microsecond, so that a long soak takes no more memory than a short one.
class MicrosecondCounts {
 public:
  void add(std::int64_t nanoseconds);
  /// The smallest count of microseconds that `share` of all do not exceed; the last is exact.
  [[nodiscard]] double quantile_us(double share) const;
  [[nodiscard]] std::uint64_t above_us(std::size_t bound) const;

 private:
  std::vector<std::uint32_t> counts_ = std::vector<std::uint32_t>(100'001);  ///< the last: later
  std::uint64_t total_ = 0;
  std::int64_t largest_ = 0;  ///< [ns]
};

class SoakFigures {
 public:
  explicit SoakFigures(JointLimits limits, double cycle)
      : limits_(std::move(limits)), cycle_(cycle) {}

  /// A run that has ended: every cycle of its log against the limits and, but where a jog has led
  /// the arm away, against the way that it had to go.
  void judge(const Job& job, const Trajectory& way, bool stop_told);
  /// Something is wrong; the first few are told on standard error. Threads: any.
  void note(const std::string& what);
  /// Resident memory now [MB], of a process that rests.
  void note_memory();

  [[nodiscard]] bool is_sound() const { return problems_ == 0; }
  /// Prints a row of each kind. @param cycles of the loop altogether
  void print(std::uint64_t cycles, double seconds) const;

 private:
  void hold(const LogRecord& record, const LogRecord* before);

  JointLimits limits_;
  double cycle_;
  MicrosecondCounts latency_, compute_;
  std::uint64_t records_ = 0, lost_ = 0, overruns_ = 0, missed_ = 0;
  std::uint64_t runs_ = 0, finished_ = 0, stopped_ = 0;
  std::atomic<std::uint64_t> problems_{0};
  std::array<std::uint64_t, static_cast<std::size_t>(RunState::kWaiting) + 1> states_{};
  double worst_share_ = 0.0, worst_deviation_ = 0.0;
  std::vector<double> memory_;
};

}  // namespace viapoint::bench
