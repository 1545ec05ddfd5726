/// @file
/// The program's steps with geometry found, and every problem met on the way.
#pragma once

#include <memory>
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
  InputWait wait{};  ///< before it
};
/// A shorter wait is a stop and nothing else [s].
inline constexpr double kShortestWait = 1e-9;
/// How long a program rests that only asks for where the arm is already, as when it goes home from
/// there [s].
inline constexpr double kRestInstead = 2e-3;

/// How long the arm rests after an input that it waits for has come [s].
inline constexpr double kRestAtInput = 2e-3;

struct Output {
  int step = 0;
  OutputChange change;
  double distance = 0.0;  ///< along the path from the point [m]
  JointVector point;      ///< where the move before it ends
  int leg = -1;           ///< step of that move
  RobotPtr robot;         ///< with the tool whose way counts
};
using Item = std::variant<Leg, Dwell, Output>;

struct Itinerary {
  std::vector<Item> items;
  Report report;
};

/// Walks a program from its start, step by step. After a step that fails it goes on from where that
/// step was to end, so that one walk finds every problem.
class ItineraryWalk {
 public:
  /// @param program where it begins, its tolerance and its robot; its steps do not count
  ItineraryWalk(RobotPtr robot, const MotionProgram& program);
  ~ItineraryWalk();

  /// False where the program cannot begin: the report says why, and no step may be taken.
  [[nodiscard]] bool begun() const;
  void take(const Step& step, int index);
  /// No step follows: what was held back is found, too.
  void end();
  /// From now on lines are taken as they come, however near to one line.
  void merge_nothing();
  /// What was found since the last call.
  [[nodiscard]] Itinerary found();

 private:
  class Walk;
  std::unique_ptr<Walk> walk_;
};

/// The whole of a program.
[[nodiscard]] Itinerary make_itinerary(RobotPtr robot, const MotionProgram& program);

/// Adds move and source line to a problem that lacks them.
void locate(Problem& problem, const SourceLine& source, int step);
void locate(Problem& problem, const MotionProgram& program, int step);

}  // namespace viapoint::planning
