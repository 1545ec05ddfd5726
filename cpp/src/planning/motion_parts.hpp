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

/// Puts each change of output on the first piece of a later step: in the middle of the corner
/// where the point is passed, at the end of the stop where the arm rests there.
/// @returns the piece of each, as far as there are such pieces
std::vector<size_t> attach_outputs(std::span<TrajectoryPiece> pieces,
                                   std::span<const Output> outputs);

/// The warning that a corner is not as it was asked for. @pre the corner says why
[[nodiscard]] Problem warning_of(const CornerOutcome& corner);

/// A zone is a promise about one tool point, so the arm rests where the tool changes.
[[nodiscard]] CornerOutcome stop_for_tool(int move, const Zone& asked);

/// Smallest manipulability at the pieces' ends and middles; 0 without kinematics.
[[nodiscard]] double least_manipulability(const RobotModel& robot,
                                          std::span<const TrajectoryPiece> pieces);

}  // namespace viapoint::planning
