/// @file
/// The proof that a motion keeps its limits: bounds on the pieces' own polynomials, not on samples.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/core/joint_limits.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// The worst of one quantity of one joint over a whole motion.
struct Extremum {
  double value = 0.0;  ///< largest magnitude: an upper bound, at most 1e-9 (of it, or of the limit
                       ///< where that is more) above what is reached
  double share = 0.0;  ///< value over its limit
  double time = 0.0;   ///< [s] where it is reached
  int move = 0;        ///< program step it happens in
};

/// The worst of the tool over a whole motion, against the limits that each move gives it: the
/// largest share, the value of that share, and where. Zero where no move limits it.
struct ToolExtrema {
  Extremum speed;                 ///< of the tool point [m/s]
  Extremum acceleration;          ///< [m/s²]
  Extremum angular_speed;         ///< [rad/s]
  Extremum angular_acceleration;  ///< [rad/s²]
};

/// Bounds over the whole of a motion, per joint where that makes sense.
struct Certificate {
  std::vector<Extremum> velocity, acceleration, jerk;  ///< (n,)
  JointVector position_min,
      position_max;  ///< bounds within 1e-9 of what is reached [rad or m], (n,)
  /// Largest |q̇| at the ends; 0 at the start of a motion that goes on from another.
  double start_speed = 0.0, end_speed = 0.0;
  double start_acceleration = 0.0, end_acceleration = 0.0;
  /// Largest step of q, q̇, q̈ between neighbouring pieces.
  double position_jump = 0.0, velocity_jump = 0.0, acceleration_jump = 0.0;
  ToolExtrema tool;              ///< proven; filled in by the planner
  double path_deviation = 0.0;   ///< proven, outside zones [m]; filled in by the planner
  double angle_deviation = 0.0;  ///< proven, outside zones [rad]; filled in by the planner
  double zone_deviation = 0.0;   ///< largest cut of a corner at the tool [m]; by the planner
  double manipulability = 0.0;   ///< smallest found along the motion; by the planner
  /// Everything that is broken, one entry a joint and quantity with its worst place: pieces that
  /// are none, steps between pieces, ends not at rest, positions and coupled limits, rates; each
  /// group worst first. Empty: the motion may run.
  std::vector<Problem> problems;

  [[nodiscard]] bool holds() const { return problems.empty(); }
};

/// Relative slack for rounding: a share up to 1 + kLimitSlack counts as kept.
inline constexpr double kLimitSlack = 1e-6;

/// Bounds every joint's position, velocity, acceleration and jerk, the coupled limits, the ends and
/// the joints between pieces. Composes each piece's polynomials into one in τ, in Bernstein form,
/// and subdivides until bound and value agree (Lane & Riesenfeld 1981 for the bound). The bounds
/// include rounding: 32 ε k of the product of the control coefficients' magnitudes for the power k
/// of u, 4 ε of u's monomials, and 1.4e-13 of the composed coefficients where they were halved; all
/// of it below 1e-9 unless the terms of u cancel to a thousandth of their size or less.
///
/// A problem is: a share above 1 + kLimitSlack; a position or coupled limit left by more than 1e-9,
/// or 64 ε of the limit where that is more (from 7e4 rad or m on); a step between pieces of more
/// than 1e-9 in position, or 8 ε of the terms of q(u) there (from 5.6e5 on), or 1e-6 of the limit
/// in velocity or acceleration (kDiscontinuous); more than that share of velocity or acceleration
/// at an end (kNotAtRest); a piece that is malformed, not finite, or whose u leaves [0, 1] by more
/// than 1e-9 (kBadArgument).
/// @param from where the motion goes on from, if not from rest: its start must be that state as a
///        piece must begin where the one before ended
/// @throws MotionError(kBadLimits) from limits.validate(); (kBadArgument) for no pieces at all
/// Real-time: not. Cost: linear in pieces. Threads: any.
[[nodiscard]] Certificate certify(std::span<const TrajectoryPiece> pieces,
                                  const JointLimits& limits,
                                  const std::optional<JointState>& from = std::nullopt);

}  // namespace viapoint
