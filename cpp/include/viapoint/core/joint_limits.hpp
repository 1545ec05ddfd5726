/// @file
#pragma once

#include "viapoint/core/joint_vector.hpp"

namespace viapoint {

/// What each joint may do, and how joints bound one another: position_min <= q <= position_max,
/// |q̇| <= velocity, |q̈| <= acceleration, |q⃛| <= jerk, coupling_lower <= C q <= coupling_upper.
/// Units are SI and radians; an unlimited joint has infinite position limits.
struct JointLimits {
  JointVector position_min;
  JointVector position_max;
  JointVector velocity;
  JointVector acceleration;
  JointVector jerk;
  CouplingMatrix coupling;        ///< (m, n); zero rows where nothing is coupled
  CouplingVector coupling_lower;  ///< (m,)
  CouplingVector coupling_upper;  ///< (m,)

  [[nodiscard]] int joints() const { return static_cast<int>(velocity.size()); }
  [[nodiscard]] int couplings() const { return static_cast<int>(coupling.rows()); }

  /// True when every position and coupled limit holds at `q`, with `slack` [rad or m] to spare for
  /// rounding. Real-time: safe.
  [[nodiscard]] bool contains(const JointVector& q, double slack = 0.0) const;

  /// Refuses sizes that differ, NaN, position_min >= position_max, and rates that are not positive
  /// and finite, each by joint, value and what is allowed.
  /// @throws MotionError(kBadLimits)
  void validate() const;
};

}  // namespace viapoint
