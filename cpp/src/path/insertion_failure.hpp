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

/// Refuses a curve whose end lies more than `factor` times as far from the first joint as the arm
/// reaches (kUnreachable), so that nobody walks towards it. Nothing is refused where a prismatic
/// joint has no end.
void refuse_far_goal(const ForwardKinematics& arm, const JointLimits& limits,
                     const TaskCurve& curve, const JointVector& start, double factor);

/// The march has taken more pieces, or more places in them, than a curve is worth (kBadArgument).
/// @param share of the curve that they cover
[[noreturn]] void throw_endless_work(size_t pieces, double share, const InsertionOptions& options);

/// @param share of the curve where the limit is crossed
[[noreturn]] void throw_limit_crossing(const ForwardKinematics& arm, const LimitCrossing& crossing,
                                       double share, const InsertionOptions& options);

}  // namespace viapoint
