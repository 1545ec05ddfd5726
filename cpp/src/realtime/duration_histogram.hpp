/// @file
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace viapoint {

/// Quantiles of any number of durations in bounded memory. Buckets are 1 ns wide up to 128 ns and
/// then 1/64 to 1/128 of what they hold: at most 57 octaves of 64 buckets. Threads: one at a time.
/// Real-time: not.
class DurationHistogram {
 public:
  /// @param duration [ns]; negative ones count as 0
  void add(std::int64_t duration);
  /// The value that `percent` of the durations do not exceed, at most 1/64 too large and never
  /// larger than the largest [s]. 0 for no durations. @pre percent <= 100
  [[nodiscard]] double quantile(std::uint64_t percent) const;

 private:
  std::vector<std::uint64_t> counts_;  ///< as many buckets as were needed
  std::uint64_t total_ = 0;
  std::uint64_t largest_ = 0;  ///< [ns]
};

}  // namespace viapoint
