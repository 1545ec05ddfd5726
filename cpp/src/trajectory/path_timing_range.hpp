/// @file
/// What timings doubles can hold.
#pragma once

#include "trajectory/path_timing_uniform.hpp"

namespace viapoint::path_timing {

/// True for a duration of at least 1e-40 s and at most 1e40 s.
[[nodiscard]] bool in_range(double seconds);

/// Lowers a ceiling on |s̈| or |s⃛| that is so high that a phase would last less than 1e-13 of the
/// whole. Costs no more of the time than a few times that.
/// @throws MotionError(kBadArgument), naming what is extreme, if the section would last less than
///         1e-40 s or more than 1e40 s: the fifth powers of time of the proof leave doubles there
[[nodiscard]] UniformCeilings within_range(UniformCeilings ceilings, const JointPath& path,
                                           const JointLimits& limits);

}  // namespace viapoint::path_timing
