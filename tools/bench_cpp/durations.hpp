/// @file
/// Measured durations and their quantiles.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace viapoint::bench {

/// Runs `action` and returns how long it took [s].
template <typename Action>
double time_of(Action&& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Order statistics of a set of durations [s].
class Durations {
 public:
  void reserve(std::size_t count) { values_.reserve(count); }
  void add(double seconds) {
    values_.push_back(seconds);
    sorted_ = false;
  }
  [[nodiscard]] std::size_t count() const { return values_.size(); }
  /// The smallest value that `share` of all do not exceed; 0 where there is none.
  [[nodiscard]] double quantile(double share) {
    if (values_.empty()) return 0.0;
    if (!sorted_) std::ranges::sort(values_);
    sorted_ = true;
    const auto last = static_cast<double>(values_.size() - 1);
    return values_[static_cast<std::size_t>(share * last + 0.5)];
  }

 private:
  std::vector<double> values_;
  bool sorted_ = false;
};

}  // namespace viapoint::bench
