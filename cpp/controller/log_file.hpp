/// @file
#pragma once

#include <string>

namespace viapoint::controller {

/// Finds out before the arm moves whether a file can be put at `path`: by a file that is made
/// beside it and removed. What is there already stays as it is. The disk may still fill up later.
/// @throws MotionError(kFile) naming the path and the system's reason
void check_log_can_be_written(const std::string& path);

/// Keeps the log from replacing a file that the run is read from, under whatever name.
/// @throws MotionError(kFile) naming both
void check_log_is_no_input(const std::string& log, const std::string& input);

}  // namespace viapoint::controller
