#include <chrono>
#include <functional>
#include <optional>
#include <random>
#include <string>

#include "benches.hpp"
#include "durations.hpp"
#include "json_line.hpp"
#include "own_process.hpp"
#include "sample_programs.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/planning/stream_planner.hpp"

namespace viapoint::bench {
namespace {

void run(const std::string& subject, const RobotPtr& robot, int moves,
         const std::function<MotionProgram()>& make) {
  const double before = peak_memory();
  MotionProgram program;
  const double building = time_of([&] { program = make(); });
  const double program_memory = peak_memory() - before;
  const MotionPlanner planner(robot);
  PlannedMotion planned;
  const double planning = time_of([&] { planned = planner.plan(program); });
  JsonLine("growth", subject + ", " + std::to_string(moves) + " moves")
      .add("build_us_per_move", 1e6 * building / moves)
      .add("plan_us_per_move", 1e6 * planning / moves)
      .add("motion_s_per_move", planned.trajectory.duration() / moves)
      .add("pieces_per_move", static_cast<double>(planned.trajectory.pieces().size()) / moves)
      .add("program_kB_per_move", 1e-3 * program_memory / moves)
      .add("peak_kB_per_move", 1e-3 * (peak_memory() - before) / moves);
}

/// The same walk, told move by move and planned meanwhile.
void run_streamed(const RobotPtr& robot, int moves) {
  const double before = peak_memory();
  std::mt19937_64 random(1);
  MotionProgram head = random_walk(*robot, 1, 1);
  JointVector q = head.start;
  Step step;
  step.options.zone = {ZoneKind::kJointDeviation, 0.01};
  Durations chunks;
  double first_chunk = 0.0, duration = 0.0, chunk_duration = 0.0;
  int stops = 0;
  const double whole = time_of([&] {
    StreamPlanner planner(robot, head);
    const auto began = std::chrono::steady_clock::now();
    const auto hand_over = [&] {
      std::optional<MotionChunk> chunk;
      const double seconds = time_of([&] { chunk = planner.next(); });
      if (!chunk) return false;
      if (chunks.count() == 0) {
        first_chunk =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
      }
      chunks.add(seconds);
      duration += chunk->begin;
      chunk_duration = chunk->motion.duration();
      return true;
    };
    for (int k = 0; k < moves; ++k) {
      q += random_walk_step(robot->joints(), random);
      step.what = PtpMove{JointTarget{q}};
      planner.add(step);
      hand_over();
    }
    planner.end();
    while (hand_over()) {
    }
    stops = planner.stops();
  });
  JsonLine("growth", "streamed joint moves with corners, " + std::to_string(moves) + " moves")
      .add("plan_us_per_move", 1e6 * whole / moves)
      .add("first_chunk_ms", 1e3 * first_chunk)
      .add("p50_chunk_ms", 1e3 * chunks.quantile(0.5))
      .add("max_chunk_ms", 1e3 * chunks.quantile(1.0))
      .add("stops", stops)
      .add("motion_s_per_move", (duration + chunk_duration) / moves)
      .add("peak_MB", 1e-6 * (peak_memory() - before));
}

}  // namespace

void bench_growth(int moves) {
  const RobotPtr walker = walking_robot();
  const RobotPtr puma = RobotModel::make(load_description("puma560"));
  for (int count = 10; count <= moves; count *= 10) {
    apart([&] {
      run("joint moves with corners", walker, count, [&] {
        MotionProgram program = random_walk(*walker, count + 1, 1);
        for (Step& step : program.steps) step.options.zone = {ZoneKind::kJointDeviation, 0.01};
        return program;
      });
    });
    apart([&] {
      run("lines with corners", puma, count, [&] { return random_lin(*puma, count, 1); });
    });
  }
  for (int count = 10; count <= 10 * moves; count *= 10) {
    apart([&] { run_streamed(walker, count); });
  }
}

}  // namespace viapoint::bench
