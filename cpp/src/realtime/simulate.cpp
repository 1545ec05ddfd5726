#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "viapoint/core/error.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

/// A command this little after a cycle belongs to it [s].
constexpr double kCommandSlack = 1e-9;

/// More than an hour at 2 ms, and some 1.4 GB of records. A run that takes longer is a mistake.
constexpr std::uint64_t kMostCycles = 2'000'000;

[[noreturn]] void refuse(double cycles) {
  std::ostringstream text;
  text << "the simulated run takes at least " << cycles << " cycles; at most " << kMostCycles
       << " fit in its log";
  throw MotionError(ErrorCode::kBadArgument, text.str(),
                    {"give a larger override", "resume a pause earlier", "give a longer cycle",
                     "simulate the program in parts"});
}

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
  if (trajectory.duration() / seconds > static_cast<double>(kMostCycles))
    refuse(trajectory.duration() / seconds);
  std::vector<LogRecord> log;
  double share = 1.0;
  auto next = commands.begin();
  for (std::uint64_t k = 0; interpolator.active(); ++k) {
    const double now = static_cast<double>(k) * seconds;
    for (; next != commands.end() && next->time <= now + kCommandSlack; ++next) {
      apply(*next, interpolator);
      if (next->kind == TimedCommand::Kind::kOverride) share = next->value;
    }
    Setpoint setpoint;
    LogRecord record;
    interpolator.tick(setpoint);
    interpolator.describe(setpoint, record);
    record.cycle = k;
    record.stamp = static_cast<std::int64_t>(k) * cycle.count();
    log.push_back(record);
    if (record.state == RunState::kPaused && next == commands.end()) break;
    // A rate that is what it was told to be stays until the end or the next command.
    double cycles = static_cast<double>(k) + 1.0;
    if (record.state == RunState::kPaused) {
      cycles = next->time / seconds;
    } else if (record.state == RunState::kRunning && record.rate == share) {
      cycles += (trajectory.duration() - record.nominal_time) / (share * seconds);
      if (next != commands.end()) cycles = std::min(cycles, next->time / seconds);
    }
    if (cycles > static_cast<double>(kMostCycles)) refuse(cycles);
  }
  return log;
}

}  // namespace viapoint
