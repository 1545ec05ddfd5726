/// @file
#pragma once

#include <optional>
#include <string>

#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// Why `piece` is no piece of a motion of `joints` joints, as the end of a sentence that begins
/// with the piece's name. Nothing if it is one. Real-time: not.
[[nodiscard]] std::optional<std::string> find_fault(const TrajectoryPiece& piece, int joints);

}  // namespace viapoint
