/// @file
/// The classic fixed-time form (textbook §3): it starts and ends at speed and knows no limits, so
/// it is for study. It is planned whatever it breaks, and everything it breaks is reported.
#pragma once

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint {

/// Largest distance and angle of the tool from the wanted motion at the checked instants of every
/// piece of a timed Cartesian motion [m, rad].
inline constexpr double kTimedPoseError = 1e-6;

/// In joint space: the lines and quartic transitions themselves. In Cartesian space: the drive
/// transform, its joints by inverse kinematics continued along the motion with limits left aside,
/// as quintic pieces through knots with exact q, q̇ and q̈. Trajectory time runs from 0.
/// Never throws for a fault of the program: the report has what is wrong, as errors. The trajectory
/// is empty only where no motion exists (points that cannot be reached, times that cannot be laid
/// out, a singularity on the way). Deviations in its certificate are the largest at the checked
/// instants, no proven bounds.
/// @param step index of `move` in `program`; the report names it
/// Real-time: not. Threads: any, at once.
[[nodiscard]] PlannedMotion plan_timed(const RobotModel& robot, const MotionProgram& program,
                                       const TimedMove& move, int step);

}  // namespace viapoint
