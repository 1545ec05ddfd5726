/// @file
/// What a whole motion and one in chunks are both put together from.
#pragma once

#include <span>
#include <vector>

#include "planning/itinerary.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::planning {

/// How long the arm rests after its last move when outputs are still to change [s].
inline constexpr double kLastOutputs = 0.002;

[[nodiscard]] TrajectoryPiece rest_at(const JointVector& q, double seconds, int step);
[[nodiscard]] TrajectoryPiece rest_at(const JointVector& q, const Dwell& dwell);

/// The warning that a corner is not as it was asked for. @pre the corner says why
[[nodiscard]] Problem warning_of(const CornerOutcome& corner);

/// A zone is a promise about one tool point, so the arm rests where the tool changes.
[[nodiscard]] CornerOutcome stop_for_tool(int move, const Zone& asked);

/// Smallest manipulability at the pieces' ends and middles; 0 without kinematics.
[[nodiscard]] double least_manipulability(const RobotModel& robot,
                                          std::span<const TrajectoryPiece> pieces);

}  // namespace viapoint::planning
