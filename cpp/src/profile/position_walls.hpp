/// @file
/// Position limits as walls, and whether a motion stays between them.
#pragma once

#include "viapoint/profile/axis_move.hpp"

namespace viapoint {

/// Where a motion may be.
struct Walls {
  double low, high;  ///< infinite where there is none
  double slack;      ///< by which rounding may go beyond them
  /// How far a motion that starts outside may be until it has come in; the walls themselves
  /// otherwise.
  double start_low, start_high;

  /// True where no position of the motion, from the phase `first` on, is beyond a wall, those on
  /// the way in aside. Exact. Real-time: safe.
  [[nodiscard]] bool hold(const AxisMove& move, int first = 0) const noexcept;
};

[[nodiscard]] Walls mirrored(const Walls& walls) noexcept;

}  // namespace viapoint
