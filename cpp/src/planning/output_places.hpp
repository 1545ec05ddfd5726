/// @file
/// Where on a finished motion each output changes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "planning/itinerary.hpp"
#include "viapoint/core/joint_limits.hpp"
#include "viapoint/trajectory/tool_certificate.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::planning {

/// What is known besides some pieces.
struct Surroundings {
  bool from_start = true;  ///< the program begins with the first piece
  bool to_end = true;      ///< nothing follows
  bool move_ends = true;   ///< the last piece ends a move, at rest
};

/// Puts each change of output where it belongs. An output stands at the point where the moves
/// before it end: in a corner the place of the path that is nearest to that point, at a stop the
/// end of the stop; or its distance from there along the path of the tool. Pieces are cut in two
/// where one is to change inside.
/// @param tool one for each piece, or none
/// @returns the piece of each; none for one whose place is not known yet, and, of the same output,
///   for those after it. What lies before a first piece that is not the program's is at the
///   beginning of it.
/// @throws MotionError(kBadArgument): a distance that is longer than the move it is told on;
/// changes
///   of one output that come in another order than they are told in. With the output's step.
std::vector<std::optional<size_t>> attach_outputs(std::vector<TrajectoryPiece>& pieces,
                                                  std::vector<ToolLimits>& tool,
                                                  std::span<const Output> outputs,
                                                  const Surroundings& around);

/// Of an output whose place was not among `pieces`: what is left of its distance, from where they
/// are left at `end` [s from their beginning], if its point is behind that.
void move_point(Output& output, std::span<const TrajectoryPiece> pieces, double end);

}  // namespace viapoint::planning
