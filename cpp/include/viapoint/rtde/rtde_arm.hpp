/// @file
/// What an RTDE server needs of an arm.
#pragma once

#include <cstdint>

#include "viapoint/realtime/loop_cycle.hpp"

namespace viapoint {

/// An arm of six joints whose clients look on, turn its speed slider and switch its outputs.
/// Threads: the server's one. Real-time: not.
class RtdeArm {
 public:
  virtual ~RtdeArm() = default;
  /// The cycle last done. Its stamp is of CLOCK_MONOTONIC.
  [[nodiscard]] virtual LoopCycle newest_cycle() = 0;
  /// @param share of the planned speed, in [0, 1]
  virtual void set_override(double share) = 0;
  /// As ControllerLoop::switch_outputs.
  virtual void switch_outputs(std::uint64_t mask, std::uint64_t values) = 0;
};

}  // namespace viapoint
