#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "benches.hpp"
#include "durations.hpp"
#include "json_line.hpp"
#include "sample_programs.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "worst_share.hpp"

namespace viapoint::bench {
namespace {

void run(double deviation, int points, int paths) {
  const RobotPtr robot = walking_robot();
  const MotionPlanner planner(robot);
  Durations seconds, ratios;
  double share = 0.0;
  std::size_t pieces = 0;
  for (int seed = 0; seed < paths; ++seed) {
    MotionProgram program = random_walk(*robot, points, static_cast<std::uint64_t>(seed));
    for (Step& step : program.steps) step.options.zone = {};
    const double stopping = planner.plan(program).trajectory.duration();
    for (Step& step : program.steps) {
      step.options.zone = {ZoneKind::kJointDeviation, deviation};
    }
    PlannedMotion planned;
    seconds.add(time_of([&] { planned = planner.plan(program); }) / points);
    ratios.add(planned.trajectory.duration() / stopping);
    share = std::max(share, worst_share(planned.trajectory.certificate()));
    pieces += planned.trajectory.pieces().size();
  }
  const std::string subject =
      std::to_string(points) + " points, " + std::to_string(deviation).substr(0, 4) + " rad";
  JsonLine("walk", subject)
      .add("paths", paths)
      .add("p50_time_over_stopping", ratios.quantile(0.5))
      .add("max_time_over_stopping", ratios.quantile(1.0))
      .add("p50_us_per_point", 1e6 * seconds.quantile(0.5))
      .add("max_us_per_point", 1e6 * seconds.quantile(1.0))
      .add("pieces_per_point", static_cast<double>(pieces) / points / paths)
      .add("worst_share", share);
}

}  // namespace

void bench_walk(int paths) {
  for (const double deviation : {0.01, 0.05}) {
    for (const int points : {10, 100, 1000}) run(deviation, points, paths);
  }
}

}  // namespace viapoint::bench
