/// @file
/// The seven-phase S-curve as a law of one axis.
#pragma once

#include "viapoint/profile/axis_law.hpp"

namespace viapoint {

/// rest_to_rest() from q0 to q1, from time 0, under |q̇|, |q̈| and |q⃛| limits.
/// @throws MotionError(kBadArgument) unless limits > 0, all is finite and q0 != q1; and for limits
/// so far apart that doubles cannot hold both
[[nodiscard]] AxisLaw s_curve(double q0, double q1, double velocity, double acceleration,
                              double jerk);

}  // namespace viapoint
