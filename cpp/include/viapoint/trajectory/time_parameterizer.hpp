/// @file
/// Gives a section of path its timing: the quickest from rest to rest that holds velocity,
/// acceleration and jerk of every joint, between samples too.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/path/tool_rates.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// @param path   one section, C² inside but for a factor on s where pieces meet, at rest at both
///               ends
/// @param limits velocity, acceleration and jerk; piece.scale applies on top
/// @returns pieces from rest to rest with every share <= 1 + 1e-9, proven by certify(); each piece
///          lies within one path piece. Always succeeds for a valid path: its last resort is a
///          uniform stretch of time, which keeps the geometry.
/// @throws MotionError(kBadArgument) for a path without pieces, of other joints than the limits, or
///         with numbers that are not finite, or so extreme that the section would last less than
///         1e-40 s or more than 1e40 s; (kZeroLength) where no joint moves; (kBadLimits)
/// A straight section gets the exact seven phases. Any other is optimised over ṡ² along the path
/// (Verscheure et al. 2009, with jerk by the convex-concave procedure) and ends within about two
/// per cent of the quickest; where the optimiser gets nowhere, the seven-phase move under bounds
/// that hold all along the section is returned. Real-time: not. Cost: linear in pieces.
[[nodiscard]] std::vector<TrajectoryPiece> parameterize(const JointPath& path,
                                                        const JointLimits& limits);

/// A section with its timing.
struct TimedPath {
  std::vector<TrajectoryPiece> pieces;
  std::vector<std::size_t> origin;  ///< the path piece that each lies in
};

/// The same with the tool held, too: speed, acceleration, angular speed and angular acceleration
/// of every piece that limits them, with every share <= 1 + 1e-9 and the tool rates' error counted
/// against the limits.
/// @param tool one a piece of the path (with_tool_rates()), or none
[[nodiscard]] TimedPath parameterize(const JointPath& path, const JointLimits& limits,
                                     std::span<const ToolRates> tool);

}  // namespace viapoint
