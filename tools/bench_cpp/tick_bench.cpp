#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <random>
#include <stdexcept>
#include <vector>

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

/// What happens before a tick, not measured.
using Disturb = std::function<void(Interpolator&, int)>;

/// What every tick takes: by the clock, by the processor, and by the processor the less of two
/// passes. Those do the same ticks, so what only one of them takes is the machine's, not the
/// work's.
struct TickTimes {
  Durations clock, processor, twice;
};

/// Runs the motion, which ends where it starts, again and again.
double run_once(const Trajectory& motion, const JointLimits& limits, int ticks,
                const Disturb& disturb, TickTimes& times, std::vector<double>& least) {
  Interpolator interpolator(limits, std::chrono::milliseconds(2), motion.at(0.0).q);
  Setpoint setpoint;
  double checksum = 0.0;
  for (int i = 0; i < ticks; ++i) {
    if (!interpolator.active()) interpolator.begin(motion);
    disturb(interpolator, i);
    const double before = processor_time();
    const double by_clock = time_of([&] { (void)interpolator.tick(setpoint); });
    const double by_processor = processor_time() - before;
    times.clock.add(by_clock);
    times.processor.add(by_processor);
    double& of_tick = least[static_cast<std::size_t>(i)];
    of_tick = std::min(of_tick, by_processor);
    checksum += setpoint.q[0];
  }
  return checksum;
}

/// @param make_disturb what happens, from the start, the same in every pass
void run(const char* subject, const Trajectory& motion, const JointLimits& limits, int ticks,
         const std::function<Disturb()>& make_disturb) {
  TickTimes times;
  std::vector<double> least(static_cast<std::size_t>(ticks), 1e300);
  const double checksum = run_once(motion, limits, ticks, make_disturb(), times, least);
  if (run_once(motion, limits, ticks, make_disturb(), times, least) != checksum) {
    throw std::logic_error("the passes are not the same");
  }
  for (const double time : least) times.twice.add(time);
  JsonLine("tick", subject)
      .add("ticks", times.twice.count())
      .add("pieces", motion.pieces().size())
      .add("p50_us", 1e6 * times.clock.quantile(0.5))
      .add("p99_us", 1e6 * times.clock.quantile(0.99))
      .add("p99_99_us", 1e6 * times.clock.quantile(0.9999))
      .add("max_us", 1e6 * times.clock.quantile(1.0))
      .add("processor_p50_us", 1e6 * times.processor.quantile(0.5))
      .add("processor_p99_us", 1e6 * times.processor.quantile(0.99))
      .add("processor_p99_99_us", 1e6 * times.processor.quantile(0.9999))
      .add("processor_max_us", 1e6 * times.processor.quantile(1.0))
      .add("twice_p99_99_us", 1e6 * times.twice.quantile(0.9999))
      .add("twice_max_us", 1e6 * times.twice.quantile(1.0))
      .add("clock_us", 1e6 * clock_cost())
      .add("checksum", checksum);
}

}  // namespace

void bench_tick(int ticks) {
  const RobotPtr robot = RobotModel::make(load_description("puma560"));
  const PlannedMotion planned = MotionPlanner(robot).plan(random_ptp(*robot, 20, 1));
  const JointLimits& limits = robot->limits();
  run("full_speed", planned.trajectory, limits, ticks, [] { return [](Interpolator&, int) {}; });
  run("override_every_100_ms", planned.trajectory, limits, ticks, [] {
    return [](Interpolator& interpolator, int i) {
      if (i % 50 == 0) interpolator.set_override(0.2 + 0.2 * (i / 50 % 5));
    };
  });
  run("pause_and_resume", planned.trajectory, limits, ticks, [] {
    return [](Interpolator& interpolator, int i) {
      if (i % 100 == 0) interpolator.wish(i / 100 % 2 == 0 ? Wish::kRun : Wish::kPause);
    };
  });
  run("commands_at_random", planned.trajectory, limits, ticks, [] {
    return [random = std::mt19937(1)](Interpolator& interpolator, int) mutable {
      std::uniform_real_distribution<double> unit(0.0, 1.0);
      if (unit(random) > 0.02) return;
      if (unit(random) < 0.5) return interpolator.set_override(unit(random));
      const double what = unit(random);
      interpolator.wish(what < 0.2 ? Wish::kPause : what < 0.4 ? Wish::kBackward : Wish::kRun);
    };
  });
}

}  // namespace viapoint::bench
