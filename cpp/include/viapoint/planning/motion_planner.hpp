/// @file
/// From a program to a proven trajectory, and the report of everything that is wrong with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/program/motion_program.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// What became of the zone of one move.
struct CornerOutcome {
  int move = 0;
  Zone asked;
  bool stopped = false;      ///< the arm stops at the point
  double used = 0.0;         ///< size really used, in the zone's own unit
  double used_angle = 0.0;   ///< the same of the zone's angle [rad]; 0 for a zone without
  bool angle_rules = false;  ///< the angle was used up before the size, or left no corner at all
  /// The move whose straight leg the point was merged into: it lies so near that leg, by `used`,
  /// that it makes no corner.
  std::optional<int> merged_into;
  double cut = 0.0;    ///< proven largest distance of the tool from its legs [m]
  std::string reason;  ///< why shrunk or stopped; empty where used as asked
};

/// Limits of the tool that hold for a while.
struct ToolSpan {
  int move = 0;
  double from = 0.0, to = 0.0;  ///< [s] of the motion
  ToolLimits limits;
};

/// A stretch of motion in which a move could not hold its process speed.
struct ProcessStretch {
  int move = 0;
  double from = 0.0, to = 0.0;  ///< [s] of the motion
  /// Way of the tool point since the process speed began to be asked for [m].
  double from_length = 0.0, to_length = 0.0;
  double process_speed = 0.0;  ///< asked for [m/s]
  double lowest_speed = 0.0;   ///< [m/s]
  /// What rules there: "rest" where the arm starts or stops in it, else the limit that holding the
  /// speed would break most, or that is used most: "velocity", "acceleration", "jerk" of a joint,
  /// "tool acceleration", "tool angular speed" or "tool angular acceleration"; "timing" where the
  /// tool keeps a lower speed along most of it though no limit asks for less.
  std::string limit;
  std::optional<int> joint;
};

/// All problems of a program at once, in program order.
struct Report {
  std::vector<Problem> problems;

  [[nodiscard]] bool ok() const;  ///< no errors (warnings may be there)
  [[nodiscard]] std::string describe() const;
};

struct PlannedMotion {
  Trajectory trajectory;
  std::vector<CornerOutcome> corners;
  std::vector<ProcessStretch> process_stretches;  ///< in the order of time
  std::vector<ToolSpan> tool_spans;               ///< in the order of time
  Report report;  ///< warnings; for timed programs also the limits they break
};

/// Immutable; keeps the robot alive. Real-time: not. Threads: any, at once.
class MotionPlanner {
 public:
  explicit MotionPlanner(RobotPtr robot);

  /// Looks at every step without moving anything; never throws for a fault of the program.
  [[nodiscard]] Report check(const MotionProgram& program) const;
  /// @throws MotionError: the first error of the report
  [[nodiscard]] PlannedMotion plan(const MotionProgram& program) const;

 private:
  RobotPtr robot_;
};

}  // namespace viapoint
