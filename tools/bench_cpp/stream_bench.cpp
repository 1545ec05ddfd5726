// A script that tells moves for hours, in virtual time: does anything grow with their number?
#include <chrono>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "benches.hpp"
#include "durations.hpp"
#include "json_line.hpp"
#include "own_process.hpp"
#include "sample_programs.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/virtual_loop.hpp"
#include "viapoint/streaming/motion_stream.hpp"

namespace viapoint::bench {
namespace {

/// Ten times the usual one, so that hours of motion take minutes.
constexpr std::chrono::milliseconds kCycle{20};
constexpr double kMargin = 0.1;  ///< [s]
constexpr int kAhead = 64;
/// Records the log keeps: it is full before the smallest stream has ended.
constexpr std::size_t kRecords = 10'000;

void run(const RobotPtr& robot, int moves) {
  const double before = peak_memory();
  std::mt19937_64 random(1);
  MotionProgram head = random_walk(*robot, 1, 1);
  JointVector q = head.start;
  Step step;
  step.options.zone = {ZoneKind::kJointDeviation, 0.01};
  step.source = {"script.py", 1};

  LoopOptions options;
  options.cycle = kCycle;
  options.log_records = kRecords;
  VirtualLoop loop(std::make_unique<SimulatedDrive>(head.start), robot->limits(), options);
  std::shared_ptr<OpenJob> job;
  MotionStream stream(
      robot, head,
      [&](std::shared_ptr<const Trajectory> first) {
        job = loop.follow(std::move(first));
        return job;
      },
      kMargin);
  const auto pass = [&] {
    loop.pass(2);
    stream.hand_over();
  };
  const double seconds = time_of([&] {
    for (int k = 0; k < moves; ++k) {
      while (stream.steps_ahead() >= kAhead) pass();
      q += random_walk_step(robot->joints(), random);
      step.what = PtpMove{JointTarget{q}};
      stream.add(step);
    }
    stream.end();
    while (loop.busy()) pass();
  });
  if (job->state() != RunState::kFinished) {
    throw std::runtime_error("a stream has not come to its end: " + loop.fault());
  }
  JsonLine("stream", "joint moves with corners, " + std::to_string(moves) + " moves")
      .add("us_per_move", 1e6 * seconds / moves)
      .add("motion_s_per_move", job->duration() / moves)
      .add("late", static_cast<double>(stream.late_count()))
      .add("peak_MB", 1e-6 * (peak_memory() - before));
}

}  // namespace

void bench_stream(int moves) {
  const RobotPtr walker = walking_robot();
  for (int count = moves / 100; count <= moves; count *= 10) {
    if (count > 0) apart([&] { run(walker, count); });
  }
}

}  // namespace viapoint::bench
