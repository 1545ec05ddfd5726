/// @file
/// The program's steps with geometry found, and every problem met on the way.
#pragma once

#include <variant>
#include <vector>

#include "planning/leg.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::planning {

struct Dwell {
  int step = 0;
  double seconds = 0.0;
};
/// A shorter wait is a stop and nothing else [s].
inline constexpr double kShortestWait = 1e-9;
/// How long a program rests that only asks for where the arm is already, as when it goes home from
/// there [s].
inline constexpr double kRestInstead = 2e-3;

struct Output {
  int step = 0;
  OutputChange change;
};
using Item = std::variant<Leg, Dwell, Output>;

struct Itinerary {
  std::vector<Item> items;
  Report report;
};

/// Walks the program from its start. After a step that fails it goes on from where that step was
/// to end, so that one run finds every problem.
[[nodiscard]] Itinerary make_itinerary(RobotPtr robot, const MotionProgram& program);

/// Adds move and source line to a problem that lacks them.
void locate(Problem& problem, const MotionProgram& program, int step);

}  // namespace viapoint::planning
