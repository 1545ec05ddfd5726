#include "controller/options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>

#include "controller/exit_code.hpp"

namespace viapoint::controller {

CommandLine read_command_line(int argc, const char* const* argv) {
  Options options;
  double cycle_ms = 2.0;
  CLI::App app{
      "Runs a motion program on a simulated arm, one setpoint a cycle, or serves an arm to\n"
      "programs that connect to it."};
  app.name("viapoint-controller");
  auto* robot =
      app.add_option("--robot", options.robot, "a built-in robot, or a .yaml or .urdf file");
  auto* program = app.add_option("--program", options.program, "the program, a .json file");
  auto* log = app.add_option("--log", options.log, "where to write every cycle's setpoint, as CSV");
  auto* cycle =
      app.add_option("--cycle-ms", cycle_ms, "the cycle in milliseconds")
          ->check(CLI::Range(0.1, 1000.0))
          ->check([](const std::string& text) {
            // NaN is inside every range.
            return text.find_first_of("nN") == std::string::npos ? std::string() : "not a number";
          })
          ->capture_default_str();
  auto* virtual_time =
      app.add_flag("--virtual", options.virtual_time,
                   "run in virtual time: the same setpoints, as fast as the processor can");
  auto* config = app.add_option("--config", options.config,
                                "serve an arm instead: what and where, a .yaml file");
  robot->needs(program, log);
  program->needs(robot, log);
  log->needs(robot, program);
  config->excludes(robot, program, log, cycle, virtual_time);
  app.footer(
      "Exit codes: 0 the motion ran to its end; 1 program or motion refused, nothing moved;\n"
      "2 wrong command line; 3 a file cannot be read or the log not written (if the arm has "
      "moved,\n"
      "the result table is printed all the same); 4 the drive failed;\n"
      "5 stopped by SIGINT or SIGTERM, the arm rests on its path.");
  try {
    app.parse(argc, argv);
    if (robot->empty() && config->empty()) {
      throw CLI::RequiredError("--robot, --program and --log, or --config");
    }
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error) == 0 ? kFinished : kUsage};
  }
  options.cycle = std::chrono::nanoseconds(std::llround(cycle_ms * 1e6));
  return {options, kFinished};
}

}  // namespace viapoint::controller
