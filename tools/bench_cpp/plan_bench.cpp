#include <algorithm>
#include <cstdint>
#include <functional>

#include "benches.hpp"
#include "durations.hpp"
#include "json_line.hpp"
#include "sample_programs.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "worst_share.hpp"

namespace viapoint::bench {
namespace {

constexpr int kMoves = 10;

using MakeProgram = std::function<MotionProgram(const RobotModel&, int, std::uint64_t)>;

void run(const char* subject, const RobotPtr& robot, int programs, const MakeProgram& make) {
  const MotionPlanner planner(robot);
  Durations durations;
  int impossible = 0;
  std::size_t pieces = 0;
  double motion_time = 0.0, share = 0.0;
  for (int seed = 0; seed < programs; ++seed) {
    const MotionProgram program = make(*robot, kMoves, static_cast<std::uint64_t>(seed));
    PlannedMotion planned;
    double seconds = 0.0;
    try {
      seconds = time_of([&] { planned = planner.plan(program); });
    } catch (const MotionError&) {
      // Random programs may ask for the impossible; how many is part of the result.
      ++impossible;
      continue;
    }
    durations.add(seconds / kMoves);
    pieces += planned.trajectory.pieces().size();
    motion_time += planned.trajectory.duration();
    share = std::max(share, worst_share(planned.trajectory.certificate()));
  }
  const auto planned = static_cast<double>(durations.count());
  JsonLine("plan", subject)
      .add("programs", durations.count())
      .add("impossible", impossible)
      .add("moves_each", kMoves)
      .add("p50_ms_per_move", 1e3 * durations.quantile(0.5))
      .add("p99_ms_per_move", 1e3 * durations.quantile(0.99))
      .add("max_ms_per_move", 1e3 * durations.quantile(1.0))
      .add("pieces_per_move", planned > 0 ? static_cast<double>(pieces) / planned / kMoves : 0.0)
      .add("motion_s_per_move", planned > 0 ? motion_time / planned / kMoves : 0.0)
      .add("worst_share", share);
}

}  // namespace

void bench_plan(int programs) {
  const RobotPtr robot = RobotModel::make(load_description("puma560"));
  run("puma560_ptp", robot, programs, random_ptp);
  run("puma560_lin", robot, programs, random_lin);
}

}  // namespace viapoint::bench
