#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "realtime/require_cycle.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

/// A command this little after a cycle belongs to it [s].
constexpr double kCommandSlack = 1e-9;

/// More than an hour at 2 ms, and some 1.4 GB of records. A run that takes longer is a mistake.
constexpr std::uint64_t kMostCycles = 2'000'000;

[[noreturn]] void refuse(double cycles, std::vector<std::string> ways_out) {
  std::ostringstream text;
  text << "the simulated run takes at least " << cycles << " cycles; at most " << kMostCycles
       << " fit in its log";
  throw MotionError(ErrorCode::kBadArgument, text.str(), std::move(ways_out));
}

[[noreturn]] void refuse(double cycles) {
  refuse(cycles, {"give a larger override", "resume a pause earlier", "give a longer cycle",
                  "simulate the program in parts"});
}

void check_time(const char* what, double time) {
  if (std::isfinite(time) && time >= 0.0) return;
  throw MotionError(ErrorCode::kBadArgument, std::string(what) + " time is " + number_text(time) +
                                                 " s; it must be finite and not negative");
}

void check(const TimedCommand& command, const JointLimits& limits) {
  check_time("a command's", command.time);
  if (command.kind == TimedCommand::Kind::kJog) admit_jog(command.velocity, limits);
  if (command.kind == TimedCommand::Kind::kOverride &&
      !(command.value >= 0.0 && command.value <= 1.0)) {
    throw MotionError(ErrorCode::kBadArgument, "an override of " + number_text(command.value) +
                                                   " was given; it must lie in [0, 1]");
  }
  if (command.kind == TimedCommand::Kind::kInput &&
      (command.input < 0 || command.input >= kDigitalInputs)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "there is no input " + std::to_string(command.input) + "; inputs are 0 to " +
                          std::to_string(kDigitalInputs - 1));
  }
}

/// Rests until a command comes, if one does.
bool rests_for_good(const Interpolator& interpolator) {
  const RunState state = interpolator.state();
  return state == RunState::kPaused ||
         (state == RunState::kWaiting && std::isinf(interpolator.awaited().timeout));
}

void apply(const TimedCommand& command, Interpolator& interpolator, std::uint64_t& inputs) {
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
    case TimedCommand::Kind::kStep:
      interpolator.wish(Wish::kStep);
      break;
    case TimedCommand::Kind::kBackward:
      interpolator.wish(Wish::kBackward);
      break;
    case TimedCommand::Kind::kJog:
      interpolator.jog(command.velocity);
      break;
    case TimedCommand::Kind::kInput:
      inputs &= ~(std::uint64_t{1} << command.input);
      if (command.value != 0.0) inputs |= std::uint64_t{1} << command.input;
      interpolator.set_inputs(inputs);
      break;
  }
}

}  // namespace

std::vector<LogRecord> simulate(const Trajectory& trajectory, const JointLimits& limits,
                                std::vector<TimedCommand> commands,
                                std::chrono::nanoseconds cycle) {
  require_cycle(cycle);
  if (trajectory.pieces().empty()) {
    throw MotionError(ErrorCode::kEmptyProgram, "the motion is empty: there is nothing to run");
  }
  admit(trajectory, limits, trajectory.at(0.0).q);
  for (const TimedCommand& command : commands) check(command, limits);
  std::ranges::stable_sort(commands, {}, &TimedCommand::time);

  // First of all, as what runs them keeps something of some seconds' cycles, however short.
  const double seconds = std::chrono::duration<double>(cycle).count();
  if (trajectory.duration() / seconds > static_cast<double>(kMostCycles)) {
    refuse(trajectory.duration() / seconds);
  }
  Interpolator interpolator(limits, cycle, trajectory.at(0.0).q);
  interpolator.begin(trajectory);
  Guard guard(limits, cycle, {}, trajectory.at(0.0).q);
  std::vector<LogRecord> log;
  double share = 1.0;
  std::uint64_t inputs = 0;
  auto next = commands.begin();
  for (std::uint64_t k = 0; interpolator.active(); ++k) {
    const double now = static_cast<double>(k) * seconds;
    for (; next != commands.end() && next->time <= now + kCommandSlack; ++next) {
      apply(*next, interpolator, inputs);
      if (next->kind == TimedCommand::Kind::kOverride) share = next->value;
    }
    Setpoint setpoint;
    LogRecord record;
    interpolator.tick(setpoint);
    interpolator.describe(setpoint, record);
    if (guard.pass(setpoint) != Guard::Verdict::kPass) {
      throw MotionError(ErrorCode::kInternal, "the guard stops the simulated run at " +
                                                  number_text(now) +
                                                  " s: " + text_of(guard.breach()));
    }
    record.cycle = k;
    record.stamp = static_cast<std::int64_t>(k) * cycle.count();
    log.push_back(record);
    const bool rests = rests_for_good(interpolator);
    if (rests && next == commands.end()) break;
    // A rate that is what it was told to be stays until the end or the next command.
    double cycles = static_cast<double>(k) + 1.0;
    if (rests) {
      cycles = next->time / seconds;
    } else if (record.state == RunState::kRunning && record.rate < 0.0 && record.rate == -share) {
      cycles += record.nominal_time / (share * seconds);
      if (next != commands.end()) cycles = std::min(cycles, next->time / seconds);
    } else if (record.state == RunState::kRunning && record.rate == share) {
      cycles += (trajectory.duration() - record.nominal_time) / (share * seconds);
      if (next != commands.end()) cycles = std::min(cycles, next->time / seconds);
    }
    if (cycles > static_cast<double>(kMostCycles)) refuse(cycles);
  }
  return log;
}

void admit_jog(const JointVector& velocity, const JointLimits& limits) {
  if (velocity.size() != limits.joints()) {
    throw MotionError(ErrorCode::kBadArgument, "the jog has " + std::to_string(velocity.size()) +
                                                   " velocities, the arm has " +
                                                   std::to_string(limits.joints()) + " joints");
  }
  for (int i = 0; i < velocity.size(); ++i) {
    if (!std::isfinite(velocity[i])) {
      throw MotionError(ErrorCode::kBadArgument,
                        "the jog's velocity of joint " + std::to_string(i + 1) + " is not finite");
    }
    if (std::abs(velocity[i]) <= limits.velocity[i]) continue;
    Problem problem;
    problem.code = ErrorCode::kVelocityLimit;
    problem.message = "the jog asks joint " + std::to_string(i + 1) + " for " +
                      number_text(velocity[i]) + " rad/s or m/s; its limit is " +
                      number_text(limits.velocity[i]);
    problem.ways_out = {"jog slower"};
    problem.joint = i;
    problem.value = velocity[i];
    problem.limit = limits.velocity[i];
    throw MotionError(problem);
  }
}

std::vector<LogRecord> simulate_jog(const JointLimits& limits, const JointVector& start,
                                    std::vector<TimedJog> calls, std::chrono::nanoseconds cycle) {
  require_cycle(cycle);
  if (start.size() != limits.joints() || !start.allFinite()) {
    throw MotionError(ErrorCode::kBadArgument,
                      "a jog starts at " + std::to_string(limits.joints()) + " finite joints");
  }
  for (const TimedJog& call : calls) {
    check_time("a call's", call.time);
    admit_jog(call.velocity, limits);
  }
  std::ranges::stable_sort(calls, {}, &TimedJog::time);

  Interpolator interpolator(limits, cycle, start);
  const double seconds = std::chrono::duration<double>(cycle).count();
  const auto refuse_beyond = [](double cycles) {
    if (cycles > static_cast<double>(kMostCycles)) {
      refuse(cycles, {"call earlier", "give a longer cycle"});
    }
  };
  if (!calls.empty()) refuse_beyond(calls.back().time / seconds);
  std::vector<LogRecord> log;
  auto next = calls.begin();
  do {
    const auto k = static_cast<std::uint64_t>(log.size());
    const double now = static_cast<double>(k) * seconds;
    for (; next != calls.end() && next->time <= now + kCommandSlack; ++next) {
      interpolator.jog(next->velocity);
    }
    Setpoint setpoint;
    LogRecord record;
    interpolator.tick(setpoint);
    interpolator.describe(setpoint, record);
    record.cycle = k;
    record.stamp = static_cast<std::int64_t>(k) * cycle.count();
    log.push_back(record);
    refuse_beyond(static_cast<double>(log.size()));
  } while (next != calls.end() || interpolator.jogging());
  return log;
}

}  // namespace viapoint
