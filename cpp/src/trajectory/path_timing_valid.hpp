/// @file
/// What every timing asks of a path.
#pragma once

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint::path_timing {

/// @throws MotionError(kBadArgument) for a path that has no timing, (kBadLimits)
void require_valid(const JointPath& path, const JointLimits& limits);

}  // namespace viapoint::path_timing
