/// @file
/// Several axes, each with a law of its own, brought into one motion.
#pragma once

#include <span>
#include <vector>

#include "viapoint/profile/axis_law.hpp"

namespace viapoint {

/// When the axes of one motion move.
enum class AxisTiming : unsigned char {
  kSequential,    ///< one after the other, in their order
  kSimultaneous,  ///< all start together, each at its own pace, and waits at its end
  kSynchronised,  ///< all start together and arrive together with the slowest
};

/// The laws on one clock: all begin where the first does and end together, and none is quicker
/// than it was. Synchronised laws are stretched; in the others an axis rests before and after its
/// own motion. Synchronised laws of one shape (all cubics, all quintics from rest to rest) make a
/// straight line in joint space.
/// @throws MotionError(kBadArgument) for no law, laws that begin at different times, and, unless
/// synchronised, a law that would have to rest where it has speed
[[nodiscard]] std::vector<AxisLaw> timed_together(std::span<const AxisLaw> laws, AxisTiming timing);

}  // namespace viapoint
