/// @file
/// Gives a section of path its timing: the quickest from rest to rest that holds velocity,
/// acceleration and jerk of every joint, between samples too.
#pragma once

#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// @param path   one section, C² inside, at rest at both ends
/// @param limits velocity, acceleration and jerk; piece.scale, rate_limit and rate_change_limit
///               apply on top
/// @returns pieces from rest to rest with every share <= 1 + 1e-9, proven by certify(); each piece
///          lies within one path piece. Always succeeds for a valid path: its last resort is a
///          uniform stretch of time, which keeps the geometry.
/// Real-time: not. Cost: linear in pieces.
[[nodiscard]] std::vector<TrajectoryPiece> parameterize(const JointPath& path,
                                                        const JointLimits& limits);

}  // namespace viapoint
