#include "controller/run_program.hpp"

#include <spdlog/spdlog.h>

#include <memory>
#include <utility>

#include "controller/exit_code.hpp"
#include "controller/log_file.hpp"
#include "controller/result_table.hpp"
#include "controller/stop_signals.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/program/motion_program.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/log_csv.hpp"

namespace viapoint::controller {
namespace {

/// How long a signal may wait until it is looked for [s].
constexpr double kSignalPeriod = 0.02;

void check_start(const MotionProgram& program, const RobotModel& robot, const std::string& path) {
  if (program.start.size() == robot.joints()) return;
  Problem problem;
  problem.code = ErrorCode::kBadProgram;
  problem.file = path;
  problem.message = "the start has " + std::to_string(program.start.size()) + " values, \"" +
                    robot.name() + "\" has " + std::to_string(robot.joints()) + " joints";
  problem.ways_out = {"give \"start\" one value a joint",
                      "run it with the description of the robot it was written for"};
  throw MotionError(std::move(problem));
}

void check_fingerprint(const MotionProgram& program, const RobotModel& robot,
                       const std::string& path) {
  if (program.robot_fingerprint.empty() || program.robot_fingerprint == robot.fingerprint()) {
    return;
  }
  Problem problem;
  problem.code = ErrorCode::kBadProgram;
  problem.file = path;
  problem.message = "the program was written for robot \"" + program.robot + "\" (fingerprint " +
                    program.robot_fingerprint + "), not for \"" + robot.name() +
                    "\" (fingerprint " + robot.fingerprint() + ")";
  problem.ways_out = {"run it with the description of the robot it was written for",
                      "export it again from a script that uses this robot"};
  throw MotionError(std::move(problem));
}

Trajectory plan(const RobotPtr& robot, const MotionProgram& program) {
  PlannedMotion motion = MotionPlanner(robot).plan(program);
  for (const Problem& problem : motion.report.problems) spdlog::warn("{}", problem.describe());
  spdlog::info("planned {} pieces, {:.3f} s", motion.trajectory.pieces().size(),
               motion.trajectory.duration());
  return std::move(motion.trajectory);
}

/// Waits for the end, which a signal brings about on the path.
int wait_for_end(Job& job, StopSignals& signals) {
  try {
    while (!job.wait(kSignalPeriod)) {
      if (!signals.arrived()) continue;
      spdlog::warn("stopping on the path");
      job.stop();
    }
  } catch (const MotionError& error) {
    spdlog::error("{}", error.problem().describe());
    return error.code() == ErrorCode::kDriveFault ? kDriveFault : kStopped;
  }
  return job.state() == RunState::kFinished ? kFinished : kStopped;
}

/// False where the log could not be written: the arm has moved all the same, and what is known of
/// that is still worth telling.
bool wrote_log(const Job& job, const std::string& path) {
  const std::vector<LogRecord> log = job.log();
  try {
    write_log_csv(path, log);
  } catch (const MotionError& error) {
    spdlog::error("the motion is over, but its log was not written: {}",
                  error.problem().describe());
    return false;
  }
  spdlog::info("wrote {} cycles to {}", log.size(), path);
  return true;
}

}  // namespace

int exit_code_of(const MotionError& error) {
  switch (error.code()) {
    case ErrorCode::kFile:
    case ErrorCode::kBadRobot:
    case ErrorCode::kBadProgram:
      return kUnreadable;
    case ErrorCode::kDriveFault:
      return kDriveFault;
    default:
      return kRefused;
  }
}

int run_program(const Options& options, std::ostream& out) {
  check_log_can_be_written(options.log);
  check_log_is_no_input(options.log, options.program);
  check_log_is_no_input(options.log, options.robot);
  const RobotPtr robot = RobotModel::make(load_description(options.robot));
  const MotionProgram program = load_program(options.program);
  check_fingerprint(program, *robot, options.program);
  check_start(program, *robot, options.program);
  const auto trajectory = std::make_shared<const Trajectory>(plan(robot, program));

  StopSignals signals;
  LoopOptions loop_options;
  loop_options.cycle = options.cycle;
  std::unique_ptr<Clock> clock = std::make_unique<MonotonicClock>();
  if (options.virtual_time) clock = std::make_unique<VirtualClock>();
  ControllerLoop loop(std::make_unique<SimulatedDrive>(program.start), robot->limits(),
                      loop_options, std::move(clock));
  for (const std::string& line : loop.shortcomings()) spdlog::warn("{}", line);

  const std::shared_ptr<Job> job = loop.run(trajectory);
  const int code = wait_for_end(*job, signals);
  const bool logged = wrote_log(*job, options.log);
  out << result_table(*trajectory, *job) << std::flush;
  return logged || code == kDriveFault ? code : kUnreadable;
}

}  // namespace viapoint::controller
