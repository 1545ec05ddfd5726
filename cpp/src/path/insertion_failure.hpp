/// @file
/// Finds out and says why a curve cannot be followed any farther.
#pragma once

#include "path/curve_follower.hpp"
#include "viapoint/path/position_limits.hpp"

namespace viapoint {

/// The march stopped at s: too few joints (kUncontrolled), beyond the workspace (kUnreachable), or
/// a singularity that the joints cannot pass (kSingular).
[[noreturn]] void throw_insertion_failure(const CurveFollower& follower, const TaskCurve& curve,
                                          const PathPoint& here, double s,
                                          const InsertionOptions& options);

/// @param share of the curve where the limit is crossed
[[noreturn]] void throw_limit_crossing(const ForwardKinematics& arm, const LimitCrossing& crossing,
                                       double share, const InsertionOptions& options);

}  // namespace viapoint
