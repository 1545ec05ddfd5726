// Runs the real-time path under RealtimeSanitizer, which ends the process at the first heap call,
// lock or system call below a function marked VIAPOINT_NONBLOCKING. With --allocate it does what is
// forbidden, to show that it would be caught.
#include <array>
#include <cstdio>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "realtime/random_motion.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/profile/state_to_state.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/guard.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr int kCycles = 100'000;

void allocate() noexcept VIAPOINT_NONBLOCKING {
  const std::vector<double> forbidden(1000);
  std::printf("%p\n", static_cast<const void*>(forbidden.data()));
}

void command_at_random(std::mt19937& random, Interpolator& interpolator, int cycle) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  if (cycle > 1500) return interpolator.wish(Wish::kStop);
  if (cycle > 1000) {
    interpolator.wish(Wish::kRun);
    return interpolator.set_override(1.0);
  }
  if (unit(random) > 0.03) return;
  if (unit(random) < 0.5) return interpolator.set_override(unit(random));
  constexpr std::array kWishes = {Wish::kPause, Wish::kRun, Wish::kRun, Wish::kStep,
                                  Wish::kBackward};
  interpolator.wish(kWishes[static_cast<std::size_t>(unit(random) * 4.999)]);
}

/// A chain of joints about z, and a tool that the guard looks at and never stops.
GuardOptions tool_guard(int joints) {
  Pose tool = Pose::Identity();
  tool.translation().x() = 1.0;
  const std::vector<ChainJoint> chain(static_cast<std::size_t>(joints));
  GuardOptions options;
  options.kinematics = ForwardKinematics(chain, tool);
  options.tool_speed = 1e6;
  return options;
}

void tick_with_commands() {
  int ticks = 0, stopped = 0, breaches = 0;
  for (unsigned seed = 0; ticks < kCycles; ++seed) {
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    Interpolator interpolator(motion.limits, kCycle, motion.trajectory.at(0.0).q);
    interpolator.begin(motion.trajectory);
    Guard guard(motion.limits, kCycle, tool_guard(motion.limits.joints()),
                motion.trajectory.at(0.0).q);
    const JointVector away = 0.1 * motion.limits.velocity;
    Setpoint setpoint;
    for (int k = 0; interpolator.active(); ++k, ++ticks) {
      command_at_random(random, interpolator, k);
      if (interpolator.state() == RunState::kPaused && k % 50 < 5) interpolator.jog(away);
      interpolator.tick(setpoint);
      if (seed % 5 == 0 && k == 100) setpoint.q[0] += 1.0;
      guard.pass(setpoint);
      guard.look_at(DriveStatus::kOk, {setpoint.q, 0});
      if (!guard.breach().any()) continue;
      ++breaches;
      while (guard.pass(setpoint) == Guard::Verdict::kOffPath) {
      }
      break;
    }
    stopped += interpolator.state() == RunState::kStopped ? 1 : 0;
  }
  std::printf("%d ticks, %d motions stopped on their path, %d by the guard\n", ticks, stopped,
              breaches);
}

/// Jogs with position and coupled limits in the way.
void jog_at_random() {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    const JointLimits& limits = motion.limits;
    Interpolator interpolator(limits, kCycle, motion.trajectory.at(0.0).q);
    Setpoint setpoint;
    JointVector wish(limits.joints());
    for (int cycle = 0; cycle < 2000; ++cycle) {
      for (int i = 0; i < wish.size(); ++i) wish[i] = unit(random) * limits.velocity[i];
      if (cycle % 40 == 0) interpolator.jog(wish);
      interpolator.tick(setpoint);
    }
  }
  std::printf("20 jogs\n");
}

/// State to state, with and without position limits.
void plan_at_random() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  StateToState motion;
  int planned = 0;
  for (int k = 0; k < 20'000; ++k) {
    std::array<AxisState, 3> start, end;
    std::array<AxisLimits, 3> limits;
    for (std::size_t i = 0; i < 3; ++i) {
      start[i] = {unit(random), unit(random), unit(random), 0.0};
      end[i] = {unit(random), 0.5 * unit(random), 0.5 * unit(random), 0.0};
      limits[i] = AxisLimits::symmetric(1.0, 3.0, 10.0);
      if (k % 2 == 0) limits[i].position_max = 1.1;
      if (k % 3 == 0) limits[i].position_min = -1.1;
    }
    if (motion.plan(start, end, limits) != MoveStatus::kSolved) continue;
    ++planned;
    static_cast<void>(motion.at(0.5 * motion.duration()));
  }
  std::printf("%d motions from state to state\n", planned);
}

/// Motions that are taken over to again and again while they run.
void lengthen_at_random() {
  int taken = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    Interpolator interpolator(motion.limits, kCycle, motion.trajectory.at(0.0).q);
    interpolator.begin(motion.trajectory, true);
    MotionLink link;
    link.motion = &motion.trajectory;
    Setpoint setpoint;
    for (int k = 0; interpolator.active(); ++k) {
      command_at_random(random, interpolator, k);
      link.same_until = interpolator.nominal_time() + 0.1;
      if (k % 7 == 0) taken += interpolator.lengthen(link) == LinkFate::kTaken ? 1 : 0;
      interpolator.tick(setpoint);
    }
  }
  std::printf("%d motions taken over to\n", taken);
}

void run_the_loop() {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    ControllerLoop loop(std::make_unique<SimulatedDrive>(motion.trajectory.at(0.0).q),
                        motion.limits, {}, std::make_unique<VirtualClock>());
    loop.set_override(0.5);
    const auto job = loop.run(std::make_shared<Trajectory>(motion.trajectory));
    loop.set_override(1.0);
    if (seed % 2 == 0) job->stop();
    job->wait(60.0);
  }
  std::printf("20 runs of the loop\n");
}

}  // namespace
}  // namespace viapoint

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--allocate") == 0) {
    viapoint::allocate();
    return 0;
  }
  viapoint::tick_with_commands();
  viapoint::jog_at_random();
  viapoint::lengthen_at_random();
  viapoint::plan_at_random();
  viapoint::run_the_loop();
  return 0;
}
