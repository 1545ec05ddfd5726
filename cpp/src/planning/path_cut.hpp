/// @file
#pragma once

#include "viapoint/path/joint_path.hpp"

namespace viapoint::planning {

/// The stretch of `path` from s0 to s1, its parameter multiplied by `scale`. The geometry stays.
[[nodiscard]] JointPath cut(const JointPath& path, double s0, double s1, double scale = 1.0);

}  // namespace viapoint::planning
