#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "benches.hpp"
#include "durations.hpp"
#include "json_line.hpp"
#include "sample_programs.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/trajectory/certificate.hpp"

namespace viapoint::bench {
namespace {

/// Adds the time a piece of certifying `pieces` once more.
void measure(Durations& durations, std::span<const TrajectoryPiece> pieces,
             const JointLimits& limits) {
  double checksum = 0.0;
  const double seconds = time_of([&] { checksum = certify(pieces, limits).jerk[0].value; });
  if (checksum >= 0.0) durations.add(seconds / static_cast<double>(pieces.size()));
}

void print(const char* subject, Durations& durations, std::size_t pieces, int impossible) {
  JsonLine("certificate", subject)
      .add("motions", durations.count())
      .add("impossible", impossible)
      .add("pieces", pieces)
      .add("p50_us_per_piece", 1e6 * durations.quantile(0.5))
      .add("p99_us_per_piece", 1e6 * durations.quantile(0.99));
}

template <typename Make>
void run_planned(const char* subject, const RobotPtr& robot, int programs, Make make) {
  const MotionPlanner planner(robot);
  Durations durations;
  std::size_t pieces = 0;
  int impossible = 0;
  for (int seed = 0; seed < programs; ++seed) {
    try {
      const Trajectory motion =
          planner.plan(make(*robot, 10, static_cast<std::uint64_t>(seed))).trajectory;
      measure(durations, motion.pieces(), robot->limits());
      pieces += motion.pieces().size();
    } catch (const MotionError&) {
      // A random program that is impossible has no motion to certify.
      ++impossible;
    }
  }
  print(subject, durations, pieces, impossible);
}

/// Quintics in quintics, degree 25 in time: the dearest pieces there can be.
std::vector<TrajectoryPiece> full_pieces(std::uint64_t seed, int joints) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<TrajectoryPiece> pieces(100);
  for (TrajectoryPiece& piece : pieces) {
    piece.joints = joints;
    piece.duration = 0.05 + 0.01 * unit(random);
    const double wobble = 0.1 * unit(random);
    piece.timing = {0.0, 0.8, wobble, -wobble, 0.1, 0.1};
    for (auto& row : piece.path) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(joints); ++i) row[i] = unit(random);
    }
  }
  return pieces;
}

}  // namespace

void bench_certificate(int programs) {
  const RobotPtr robot = RobotModel::make(load_description("puma560"));
  run_planned("puma560_ptp", robot, programs, random_ptp);
  run_planned("puma560_lin", robot, programs, random_lin);
  Durations durations;
  std::size_t count = 0;
  for (int seed = 0; seed < programs; ++seed) {
    const auto pieces = full_pieces(static_cast<std::uint64_t>(seed), robot->joints());
    measure(durations, pieces, robot->limits());
    count += pieces.size();
  }
  print("degree_25_six_joints", durations, count, 0);
}

}  // namespace viapoint::bench
