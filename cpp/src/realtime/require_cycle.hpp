/// @file
#pragma once

#include <chrono>
#include <string>

#include "viapoint/core/error.hpp"

namespace viapoint {

/// The tick remembers where it was for two seconds, cycle by cycle: in a shorter cycle that would
/// take all memory there is.
constexpr std::chrono::nanoseconds kLeastCycle = std::chrono::microseconds(1);

/// @throws MotionError(kBadArgument)
inline void require_cycle(std::chrono::nanoseconds cycle) {
  if (cycle >= kLeastCycle) return;
  throw MotionError(ErrorCode::kBadArgument, "the cycle is " + std::to_string(cycle.count()) +
                                                 " ns; it must be positive, and at least " +
                                                 std::to_string(kLeastCycle.count()) + " ns");
}

}  // namespace viapoint
