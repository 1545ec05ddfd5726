/// @file
/// The tools that a program changes between.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::planning {

/// Makes each arm with a tool once: two steps with the same tool have the same arm.
class ToolChanges {
 public:
  explicit ToolChanges(RobotPtr robot) : robots_{std::move(robot)} {}

  /// The arm with the tool of `step`. @throws MotionError(kUncontrolled, kBadRobot)
  [[nodiscard]] RobotPtr with(const SetTool& step);

 private:
  std::vector<RobotPtr> robots_;  ///< the first with the robot's own tool
};

/// The only moving step of a program that is a timed motion, in the base frame, with its arm.
struct TimedAlone {
  RobotPtr robot;
  TimedMove move;
  int step = 0;
};
/// Empty where the program is anything else than frames and tools and then one timed motion.
/// @throws MotionError as ToolChanges::with()
[[nodiscard]] std::optional<TimedAlone> timed_alone(const RobotPtr& robot,
                                                    const MotionProgram& program);

}  // namespace viapoint::planning
