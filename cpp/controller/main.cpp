// viapoint-controller: a program file through the real-time loop, without Python.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <iostream>

#include "controller/exit_code.hpp"
#include "controller/options.hpp"
#include "controller/run_program.hpp"
#ifdef VIAPOINT_REMOTE
#include "controller/serve.hpp"
#endif

int main(int argc, char** argv) {
  using viapoint::controller::CommandLine;
  try {
    // Results go to stdout, everything else to stderr.
    spdlog::set_default_logger(spdlog::stderr_color_mt("viapoint"));
    spdlog::set_pattern("%H:%M:%S %^%l%$ %v");
    const CommandLine command_line = viapoint::controller::read_command_line(argc, argv);
    if (!command_line.options) return command_line.exit_code;
    if (command_line.options->config.empty()) {
      return viapoint::controller::run_program(*command_line.options, std::cout);
    }
#ifdef VIAPOINT_REMOTE
    return viapoint::controller::serve(command_line.options->config);
#else
    spdlog::error("this viapoint-controller was built without its server (VIAPOINT_BUILD_REMOTE)");
    return viapoint::controller::kRefused;
#endif
  } catch (const viapoint::MotionError& error) {
    spdlog::error("{}", error.problem().describe());
    return viapoint::controller::exit_code_of(error);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return viapoint::controller::kRefused;
  }
}
