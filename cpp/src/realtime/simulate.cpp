#include <algorithm>
#include <cmath>
#include <string>

#include "viapoint/core/error.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

/// A command this little after a cycle belongs to it [s].
constexpr double kCommandSlack = 1e-9;

/// A run that takes longer is a mistake, and would fill the memory.
constexpr std::uint64_t kMostCycles = 10'000'000;

void check(const TimedCommand& command) {
  if (!std::isfinite(command.time) || command.time < 0.0) {
    throw MotionError(ErrorCode::kBadArgument, "a command's time is " +
                                                   std::to_string(command.time) +
                                                   " s; it must be finite and not negative");
  }
  if (command.kind == TimedCommand::Kind::kOverride &&
      !(command.value >= 0.0 && command.value <= 1.0)) {
    throw MotionError(ErrorCode::kBadArgument, "an override of " + std::to_string(command.value) +
                                                   " was given; it must lie in [0, 1]");
  }
}

void apply(const TimedCommand& command, Interpolator& interpolator) {
  switch (command.kind) {
    case TimedCommand::Kind::kOverride:
      interpolator.set_override(command.value);
      break;
    case TimedCommand::Kind::kPause:
      interpolator.wish(Wish::kPause);
      break;
    case TimedCommand::Kind::kResume:
      interpolator.wish(Wish::kRun);
      break;
    case TimedCommand::Kind::kStop:
      interpolator.wish(Wish::kStop);
      break;
  }
}

}  // namespace

std::vector<LogRecord> simulate(const Trajectory& trajectory, const JointLimits& limits,
                                std::vector<TimedCommand> commands,
                                std::chrono::nanoseconds cycle) {
  if (cycle.count() <= 0) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the cycle is " + std::to_string(cycle.count()) + " ns; it must be positive");
  }
  if (trajectory.pieces().empty()) {
    throw MotionError(ErrorCode::kEmptyProgram, "the motion is empty: there is nothing to run");
  }
  admit(trajectory, limits, trajectory.at(0.0).q);
  std::ranges::for_each(commands, check);
  std::ranges::stable_sort(commands, {}, &TimedCommand::time);

  Interpolator interpolator(limits, cycle, trajectory.at(0.0).q);
  interpolator.begin(trajectory);
  const double seconds = std::chrono::duration<double>(cycle).count();
  std::vector<LogRecord> log;
  auto next = commands.begin();
  for (std::uint64_t k = 0; interpolator.active(); ++k) {
    if (k >= kMostCycles) {
      throw MotionError(
          ErrorCode::kBadArgument,
          "the simulated run takes more than " + std::to_string(kMostCycles) + " cycles",
          {"give a larger override", "resume a pause earlier"});
    }
    const double now = static_cast<double>(k) * seconds;
    for (; next != commands.end() && next->time <= now + kCommandSlack; ++next) {
      apply(*next, interpolator);
    }
    Setpoint setpoint;
    LogRecord record;
    interpolator.tick(setpoint);
    interpolator.describe(setpoint, record);
    record.cycle = k;
    record.stamp = static_cast<std::int64_t>(k) * cycle.count();
    log.push_back(record);
    if (record.state == RunState::kPaused && next == commands.end()) break;
  }
  return log;
}

}  // namespace viapoint
