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

/// What the walk over the pieces found beyond the certificate's own fields.
struct Findings {
  std::vector<Problem> malformed;                  ///< pieces that are no pieces
  std::vector<JointStates> jumps;                  ///< (n,)
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
