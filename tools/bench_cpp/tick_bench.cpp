#include <time.h>

#include <chrono>
#include <functional>
#include <random>

#include "benches.hpp"
#include "durations.hpp"
#include "json_line.hpp"
#include "sample_programs.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint::bench {
namespace {

/// Processor time of this thread [s]: other programs on the machine do not count.
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What reading the clock twice costs by itself [s].
double clock_cost() {
  Durations empty;
  for (int i = 0; i < 100'000; ++i) empty.add(time_of([] {}));
  return empty.quantile(0.5);
}

/// Runs the motion, which ends where it starts, again and again.
/// @param disturb called before every tick, not measured
void run(const char* subject, const Trajectory& motion, const JointLimits& limits, int ticks,
         const std::function<void(Interpolator&, int)>& disturb) {
  Interpolator interpolator(limits, std::chrono::milliseconds(2), motion.at(0.0).q);
  Durations durations, processor;
  durations.reserve(static_cast<size_t>(ticks));
  processor.reserve(static_cast<size_t>(ticks));
  Setpoint setpoint;
  double checksum = 0.0;
  for (int i = 0; i < ticks; ++i) {
    if (!interpolator.active()) interpolator.begin(motion);
    disturb(interpolator, i);
    const double before = processor_time();
    durations.add(time_of([&] { (void)interpolator.tick(setpoint); }));
    processor.add(processor_time() - before);
    checksum += setpoint.q[0];
  }
  JsonLine("tick", subject)
      .add("ticks", durations.count())
      .add("pieces", motion.pieces().size())
      .add("p50_us", 1e6 * durations.quantile(0.5))
      .add("p99_us", 1e6 * durations.quantile(0.99))
      .add("p99_9_us", 1e6 * durations.quantile(0.999))
      .add("p99_99_us", 1e6 * durations.quantile(0.9999))
      .add("max_us", 1e6 * durations.quantile(1.0))
      .add("processor_p50_us", 1e6 * processor.quantile(0.5))
      .add("processor_p99_us", 1e6 * processor.quantile(0.99))
      .add("processor_p99_99_us", 1e6 * processor.quantile(0.9999))
      .add("processor_max_us", 1e6 * processor.quantile(1.0))
      .add("clock_us", 1e6 * clock_cost())
      .add("checksum", checksum);
}

}  // namespace

void bench_tick(int ticks) {
  const RobotPtr robot = RobotModel::make(load_description("puma560"));
  const PlannedMotion planned = MotionPlanner(robot).plan(random_ptp(*robot, 20, 1));
  const JointLimits& limits = robot->limits();
  run("full_speed", planned.trajectory, limits, ticks, [](Interpolator&, int) {});
  run("override_every_100_ms", planned.trajectory, limits, ticks,
      [](Interpolator& interpolator, int i) {
        if (i % 50 == 0) interpolator.set_override(0.2 + 0.2 * (i / 50 % 5));
      });
  run("pause_and_resume", planned.trajectory, limits, ticks, [](Interpolator& interpolator, int i) {
    if (i % 100 == 0) interpolator.wish(i / 100 % 2 == 0 ? Wish::kRun : Wish::kPause);
  });
  std::mt19937 random(1);
  run("commands_at_random", planned.trajectory, limits, ticks,
      [&random](Interpolator& interpolator, int) {
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        if (unit(random) > 0.02) return;
        if (unit(random) < 0.5) return interpolator.set_override(unit(random));
        const double what = unit(random);
        interpolator.wish(what < 0.2 ? Wish::kPause : what < 0.4 ? Wish::kBackward : Wish::kRun);
      });
}

}  // namespace viapoint::bench
