/// @file
#pragma once

#include <string>

namespace viapoint::controller {

/// Runs the arm that the configuration file describes, for programs that connect to it, until
/// SIGINT or SIGTERM; then stops on the path. Returns an ExitCode.
/// @throws MotionError for a configuration that is refused, an address that is taken, a drive that
///   cannot be enabled
[[nodiscard]] int serve(const std::string& config_path);

}  // namespace viapoint::controller
