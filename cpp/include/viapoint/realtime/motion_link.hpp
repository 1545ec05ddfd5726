/// @file
/// How a motion under way gets longer.
#pragma once

#include <cstddef>
#include <cstdint>

#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// A motion that takes the place of the one under way: the same until `same_until`, and another
/// from there. What lies behind the arm may be left out of it.
struct MotionLink {
  const Trajectory* motion = nullptr;
  double same_until = 0.0;     ///< [s] of the motion under way
  double shift = 0.0;          ///< duration of what is left out at its beginning [s]
  std::size_t dropped = 0;     ///< pieces that is
  bool begins_at_rest = true;  ///< so that the arm may go back to its beginning
};

/// What became of a link.
enum class LinkFate : std::uint8_t {
  kNotYet,   ///< to be asked again in the next cycle
  kTaken,    ///< the motion that it took the place of may be freed
  kTooLate,  ///< the arm is past where the two part: it runs the motion that it has
};

}  // namespace viapoint
