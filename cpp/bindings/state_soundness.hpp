/// @file
/// A last look at a motion before it is given to Python, which may ask for anything: doubles cannot
/// hold motions whose numbers lie too many decades apart, and those are refused and not returned.
#pragma once

#include "viapoint/profile/axis_move.hpp"

namespace viapoint::python {

/// Whether phases meet, and limits hold from where the motion is inside them, within 1e-8.
[[nodiscard]] bool is_sound(const AxisMove& move, const AxisState& start, const AxisLimits& limits);

}  // namespace viapoint::python
