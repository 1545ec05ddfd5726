// Stops on the path, with all that an optimum needs that is computed elsewhere.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iostream>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "benches.hpp"
#include "planning/random_program.hpp"
#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint::bench {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr double kSpacing = 5e-4;  ///< of the path's samples [s of nominal time]
/// The path is told this far beyond where ours has stopped: a better stop may need a little of it.
constexpr double kBeyond = 0.05;
constexpr int kMostCycles = 20'000;

struct Node {
  double tau, rate;
};

/// Rates from the cycle on in which a stop is wished, until the arm rests, at the motion's end at
/// the latest.
std::vector<Node> stop_at(const Motion& motion, double share) {
  Interpolator interpolator(motion.limits, kCycle, motion.trajectory.at(0.0).q);
  interpolator.begin(motion.trajectory);
  Setpoint setpoint;
  while (interpolator.active() &&
         interpolator.nominal_time() < share * motion.trajectory.duration()) {
    interpolator.tick(setpoint);
  }
  interpolator.wish(Wish::kStop);
  std::vector<Node> nodes;
  while (interpolator.active() && nodes.size() < kMostCycles) {
    interpolator.tick(setpoint);
    nodes.push_back({interpolator.nominal_time(), interpolator.rate()});
  }
  if (!nodes.empty()) nodes.back().rate = 0.0;  // the end may come at any rate
  return nodes;
}

template <typename Values, typename Print>
void print_list(std::string_view key, const Values& values, const Print& print) {
  std::cout << ", \"" << key << "\": [";
  bool is_first = true;
  for (const auto& value : values) {
    if (!std::exchange(is_first, false)) std::cout << ", ";
    print(value);
  }
  std::cout << ']';
}

/// A program of a few moves of every kind; empty where one of them is refused.
Motion mixed_moves(const RobotPtr& robot, std::mt19937& random) {
  testing_planner::ProgramKind kind;
  kind.moves = 6;
  kind.wild = 0.0;
  try {
    const MotionProgram program = testing_planner::random_program(*robot, kind, random);
    return {robot->limits(), MotionPlanner(robot).plan(program).trajectory};
  } catch (const MotionError&) {
    return {robot->limits(), {}};
  }
}

/// From a moment of the motion at random; nothing where it has ended by then.
void print_stop_of(std::string_view kind, const Motion& motion, std::mt19937& random) {
  if (motion.trajectory.pieces().empty()) return;
  const double share = std::uniform_real_distribution<double>(0.02, 0.98)(random);
  const std::vector<Node> nodes = stop_at(motion, share);
  if (nodes.size() < 2) return;
  const auto plain = [](double value) { std::cout << value; };
  std::cout << R"({"bench": "stops", "case": ")" << kind << R"(", "spacing": )" << kSpacing;
  print_list("acceleration", motion.limits.acceleration, plain);
  print_list("jerk", motion.limits.jerk, plain);
  print_list("rate", nodes, [](const Node& node) { std::cout << node.rate; });
  std::vector<double> path;
  const double end = std::min(motion.trajectory.duration(), nodes.back().tau + kBeyond);
  for (double tau = nodes.front().tau; tau < end + kSpacing; tau += kSpacing) {
    const JointState state = motion.trajectory.at(tau);
    for (const JointVector& part : {state.qd, state.qdd, state.qddd}) {
      path.insert(path.end(), part.begin(), part.end());
    }
  }
  print_list("path", path, plain);  // [sample, derivative, joint]
  std::cout << "}\n";
}

}  // namespace

void print_stops(int stops) {
  std::cout.precision(12);
  for (const char* name : {"puma560", "ur5e", "panda", "scara"}) {
    const RobotPtr robot = RobotModel::make(load_description(name));
    for (int seed = 0; seed < stops; ++seed) {
      std::mt19937 random(static_cast<unsigned>(seed));
      print_stop_of(std::string(name) + ", mixed moves", mixed_moves(robot, random), random);
    }
  }
  for (int seed = 0; seed < stops; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    print_stop_of("at random, as quick as the limits", random_motion(random), random);
  }
}

}  // namespace viapoint::bench
