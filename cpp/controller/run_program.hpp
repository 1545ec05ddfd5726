/// @file
#pragma once

#include <ostream>

#include "controller/options.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint::controller {

/// Loads robot and program, plans, runs the motion in the real loop on the simulated drive, writes
/// the log and prints the result table to `out`, be the log written or not. Returns an ExitCode.
/// @throws MotionError for everything that is refused before the arm moves, a log that cannot be
///   written or would overwrite program or robot included
[[nodiscard]] int run_program(const Options& options, std::ostream& out);

/// The exit code that an error ends the program with.
[[nodiscard]] int exit_code_of(const MotionError& error);

}  // namespace viapoint::controller
