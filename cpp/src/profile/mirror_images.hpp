/// @file
/// The same motion with the position upside down, or read backwards in time.
#pragma once

#include "viapoint/profile/axis_move.hpp"

namespace viapoint {

[[nodiscard]] inline AxisState mirrored(const AxisState& s) noexcept {
  return {-s.q, -s.qd, -s.qdd, -s.qddd};
}

[[nodiscard]] inline AxisLimits mirrored(const AxisLimits& l) noexcept {
  return {-l.velocity_max, -l.velocity_min, -l.acceleration_max, -l.acceleration_min,
          -l.jerk_max,     -l.jerk_min,     -l.position_max,     -l.position_min};
}

[[nodiscard]] inline AxisState reversed(const AxisState& s) noexcept {
  return {s.q, -s.qd, s.qdd, -s.qddd};
}

[[nodiscard]] inline AxisLimits reversed(const AxisLimits& l) noexcept {
  return {-l.velocity_max, -l.velocity_min, l.acceleration_min, l.acceleration_max,
          -l.jerk_max,     -l.jerk_min,     l.position_min,     l.position_max};
}

}  // namespace viapoint
