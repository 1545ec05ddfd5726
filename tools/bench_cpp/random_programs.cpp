#include <algorithm>
#include <iostream>
#include <random>
#include <string>

#include "benches.hpp"
#include "planning/random_program.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::bench {
namespace {

constexpr const char* kRobots[] = {"puma560", "ur5e", "panda", "scara"};
/// One program in so many is of moves that may ask for anything.
constexpr int kWildOnes = 5;
constexpr double kWildShare = 0.3;

}  // namespace

void print_random_programs(int programs) {
  for (const char* name : kRobots) {
    const RobotPtr robot = RobotModel::make(load_description(name));
    for (int seed = 0; seed < std::max(1, programs / 4); ++seed) {
      std::mt19937 random(static_cast<unsigned>(seed));
      testing_planner::ProgramKind kind;
      kind.moves = testing_planner::random_length(random);
      kind.wild = seed % kWildOnes == 0 ? kWildShare : 0.0;
      std::string text = to_json(testing_planner::random_program(*robot, kind, random));
      text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
      std::cout << R"({"bench": "programs", "case": ")" << name << R"(", "seed": )" << seed
                << R"(, "program": )" << text << "}\n";
    }
  }
}

}  // namespace viapoint::bench
