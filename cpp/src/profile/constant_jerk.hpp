/// @file
#pragma once

#include "viapoint/profile/jerk_profile.hpp"

namespace viapoint {

/// The state `t` after `from` at constant jerk. Real-time: safe.
[[nodiscard]] inline AxisState advanced(const AxisState& from, double jerk, double t) noexcept {
  return {from.q + t * (from.qd + t * (0.5 * from.qdd + jerk * t / 6.0)),
          from.qd + t * (from.qdd + 0.5 * jerk * t), from.qdd + jerk * t, jerk};
}

}  // namespace viapoint
