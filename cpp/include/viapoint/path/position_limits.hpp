/// @file
/// Position and coupled limits held over the whole of a polynomial piece, not at samples.
#pragma once

#include <optional>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint {

/// Where a piece first leaves a position or coupled limit.
struct LimitCrossing {
  int joint = -1;      ///< the joint, or -1 where a coupled limit is left
  int coupling = -1;   ///< row of the coupling matrix, or -1 where a joint limit is left
  double s = 0.0;      ///< where the limit is first crossed, in [0, piece.length]
  double value = 0.0;  ///< the farthest value beyond the limit that the piece reaches [rad or m]
  double limit = 0.0;  ///< the limit that is left [rad or m]
};

/// Rounding that a position limit forgives [rad or m].
inline constexpr double kPositionLimitSlack = 1e-9;

/// The first limit that the piece leaves, or nothing where every q(s) and C q(s) is proven to stay
/// within its limits: each is a quintic, held by its Bernstein control polygon (Lane & Riesenfeld
/// 1981), cut in halves where the polygon alone does not tell.
/// Real-time: not. Threads: any.
[[nodiscard]] std::optional<LimitCrossing> piece_position_violation(
    const JointPiece& piece, const JointLimits& limits, double slack = kPositionLimitSlack);

/// The value of what `crossing` names (a joint or a coupled row) that is farthest in the direction
/// of its limit, over the whole of another piece [rad or m].
[[nodiscard]] double farthest_value(const JointPiece& piece, const JointLimits& limits,
                                    const LimitCrossing& crossing);

}  // namespace viapoint
