/// @file
/// Touching a position limit from inside: there the velocity is zero, and the acceleration is the
/// only thing left to choose. A motion that starts toward the wall reaches it with those of an
/// interval. Its ends belong to the quickest changes of velocity: the gentlest touch is the one
/// that falls at once and rises then, the hardest the one that rises at first and falls then.
/// Read backwards, the same holds of the way from a wall to the end.
#pragma once

#include "viapoint/profile/axis_move.hpp"

namespace viapoint {

/// Accelerations, <= 0, at an upper wall.
struct TouchRange {
  double hardest, gentlest;
  bool forced;    ///< the motion cannot stop without touching the wall
  bool possible;  ///< false where even the hardest braking goes beyond it
};

/// True where the motion gets nearer to an upper wall whatever is done.
[[nodiscard]] bool approaches(const AxisState& s, const AxisLimits& limits) noexcept;

/// The highest position that cannot be avoided. @pre approaches(s)
[[nodiscard]] double least_peak(const AxisState& s, const AxisLimits& limits) noexcept;

/// The accelerations, <= 0, with which an axis may be at rest at an upper wall for a moment, and be
/// within its velocity limits before and after.
[[nodiscard]] double hardest_touch(const AxisLimits& limits) noexcept;

/// How a motion that approaches the wall can touch it first. Real-time: safe.
/// @pre approaches(s), s within the limits of velocity and acceleration
[[nodiscard]] TouchRange touch_range(const AxisState& s, const AxisLimits& limits,
                                     double wall) noexcept;

}  // namespace viapoint
