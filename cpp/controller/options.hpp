/// @file
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace viapoint::controller {

/// What the command line asks for.
struct Options {
  std::string config;   ///< path of a configuration file to serve by; then the rest is empty
  std::string robot;    ///< built-in name, or path of a .yaml or .urdf
  std::string program;  ///< path of a program file
  std::string log;      ///< path of the log to write
  std::chrono::nanoseconds cycle{2'000'000};
  bool virtual_time = false;
};

/// The command line, or the exit code where there is nothing to run: after --help, or after a
/// mistake that was explained on stderr.
struct CommandLine {
  std::optional<Options> options;
  int exit_code = 0;
};

[[nodiscard]] CommandLine read_command_line(int argc, const char* const* argv);

}  // namespace viapoint::controller
