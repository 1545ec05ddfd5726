#include "controller/result_table.hpp"

#include <spdlog/fmt/fmt.h>

namespace viapoint::controller {
namespace {

constexpr double kMicrosecond = 1e-6;

std::string shares(const char* name, const std::vector<Extremum>& extrema) {
  std::string line = fmt::format("{:<22}", name);
  for (const Extremum& extremum : extrema) line += fmt::format(" {:6.3f}", extremum.share);
  return line + '\n';
}

}  // namespace

std::string result_table(const Trajectory& trajectory, const Job& job) {
  const RunReport report = job.report();
  const Certificate& proof = trajectory.certificate();
  std::string table;
  table += fmt::format("{:<22} {}\n", "state", to_string(job.state()));
  table += fmt::format("{:<22} {:.6f} s of {:.6f} s\n", "nominal time", job.nominal_time(),
                       job.duration());
  table += fmt::format("{:<22} {:.6f} s\n", "wall time", report.wall_time);
  table += fmt::format("{:<22} {} ({} overruns, {} missed)\n", "cycles", report.cycles,
                       report.overruns, report.missed_cycles);
  if (report.rested_cycles > 0) {
    table += fmt::format("{:<22} {} at rest, not in the log\n", "", report.rested_cycles);
  }
  if (report.lost_records > 0) {
    table += fmt::format("{:<22} {} missing in the log\n", "lost records", report.lost_records);
  }
  table += fmt::format("{:<22} p50 {:.1f}  p99 {:.1f}  max {:.1f} us\n", "wake-up latency",
                       report.latency_p50 / kMicrosecond, report.latency_p99 / kMicrosecond,
                       report.latency_max / kMicrosecond);
  table += fmt::format("{:<22} p50 {:.1f}  p99 {:.1f}  max {:.1f} us\n", "tick",
                       report.compute_p50 / kMicrosecond, report.compute_p99 / kMicrosecond,
                       report.compute_max / kMicrosecond);
  table += shares("share of velocity", proof.velocity);
  table += shares("share of acceleration", proof.acceleration);
  table += shares("share of jerk", proof.jerk);
  table += fmt::format("{:<22} {:.2e} m, {:.2e} rad\n", "path deviation", proof.path_deviation,
                       proof.angle_deviation);
  return table;
}

}  // namespace viapoint::controller
