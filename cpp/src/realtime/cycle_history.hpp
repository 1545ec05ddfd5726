/// @file
/// The last cycles, kept for a fault.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/motion_log.hpp"

namespace viapoint {

/// A ring that only the tick writes, and that others read once the tick has said that it writes no
/// more.
template <std::size_t Capacity>
class CycleHistory {
 public:
  /// Real-time: safe.
  void append(const LogRecord& record) noexcept VIAPOINT_NONBLOCKING {
    records_[static_cast<std::size_t>(count_++ % Capacity)] = record;
  }
  /// The oldest first. Real-time: not.
  [[nodiscard]] std::vector<LogRecord> records() const {
    std::vector<LogRecord> out;
    const std::uint64_t first = count_ > Capacity ? count_ - Capacity : 0;
    for (std::uint64_t k = first; k < count_; ++k) {
      out.push_back(records_[static_cast<std::size_t>(k % Capacity)]);
    }
    return out;
  }

 private:
  std::array<LogRecord, Capacity> records_;
  std::uint64_t count_ = 0;
};

}  // namespace viapoint
