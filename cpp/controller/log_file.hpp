/// @file
#pragma once

#include <string>

namespace viapoint::controller {

/// Finds out before the arm moves whether a file can be put at `path`: by a file that is made
/// beside it and removed. What is there already stays as it is.
/// @throws MotionError(kFile) naming the path and the system's reason
void check_log_can_be_written(const std::string& path);

}  // namespace viapoint::controller
