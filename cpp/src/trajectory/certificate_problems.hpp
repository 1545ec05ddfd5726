/// @file
/// What a certificate says when something is broken.
#pragma once

#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/core/joint_limits.hpp"
#include "viapoint/trajectory/certificate.hpp"

namespace viapoint {

/// The largest of something, and where.
struct Worst {
  double value = 0.0;
  double time = 0.0;  ///< [s]
  int move = 0;
};

/// Steps of one joint between neighbouring pieces, or what it does at an end.
struct JointStates {
  Worst position, velocity, acceleration;
};

/// The step of position that most exceeds what rounding explains there.
struct PositionStep {
  Worst worst;
  double explained = 0.0;  ///< [rad or m]
};

/// What rounding explains of a step between positions of this size: 1e-9, or far from zero a few
/// units in the last place. [rad or m]
[[nodiscard]] double explained_step(double size);

/// What the walk over the pieces found beyond the certificate's own fields.
struct Findings {
  std::vector<Problem> malformed;                  ///< pieces that are no pieces
  std::vector<JointStates> jumps;                  ///< (n,)
  std::vector<PositionStep> steps;                 ///< (n,)
  std::vector<JointStates> start, end;             ///< (n,), position unused
  std::vector<Worst> lowest, highest;              ///< position (n,)
  std::vector<Worst> coupling_low, coupling_high;  ///< (m,)
};

/// Holds certificate and findings against the limits: one problem a joint and quantity, worst
/// first: malformed pieces, steps, speed at the ends, positions, rates.
[[nodiscard]] std::vector<Problem> find_problems(const Certificate& certificate,
                                                 const Findings& findings,
                                                 const JointLimits& limits);

}  // namespace viapoint
