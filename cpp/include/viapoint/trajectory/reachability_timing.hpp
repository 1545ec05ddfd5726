/// @file
/// The quickest timing of a path under velocity and acceleration alone, acceleration free to step:
/// what jerk costs, and what others without it do, is seen against it. No drive should run it.
#pragma once

#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// Reachability analysis (Pham & Pham 2018) over b = ṡ², with b linear in s over each cell, so that
/// s̈ is constant there. Backwards it finds the largest b from which the rest can be driven,
/// forwards the quickest way below that; both ends of a cell hold the limits with the cell's own s̈
/// ("interpolation"). What the limits are exceeded by within cells is proven and taken back by a
/// uniform stretch of time.
/// @param path, limits as for parameterize(); limits.jerk does not count
/// @param cells of each path piece, 1 to 10000: the more, the nearer to the quickest and the less
///        there is to take back
/// @returns pieces from rest to rest with velocity and acceleration shares <= 1 + 1e-9;
/// acceleration
///          steps, which certify() reports
/// @throws MotionError as parameterize(); kBadArgument for another number of cells
/// Real-time: not. Threads: any. Cost: linear in cells.
[[nodiscard]] std::vector<TrajectoryPiece> parameterize_without_jerk(const JointPath& path,
                                                                     const JointLimits& limits,
                                                                     int cells = 100);

}  // namespace viapoint
