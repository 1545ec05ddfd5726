/// @file
/// The polynomial of least degree that meets any set of conditions on position, velocity,
/// acceleration or jerk, at any times: cubic, quintic and septic are the best known of them.
#pragma once

#include <span>

#include "viapoint/profile/polynomial.hpp"

namespace viapoint {

/// At time t the derivative of that order (0 to 3) has that value.
struct Condition {
  double t = 0.0;  ///< [s]
  int derivative = 0;
  double value = 0.0;
};

/// The polynomial of degree k − 1 that meets k conditions, over the time they span (Biagiotti &
/// Melchiorri 2008, §2.1; the Birkhoff interpolation problem). k is 2 to 12.
/// @throws MotionError(kBadArgument) for values that are not finite, conditions at one time only, a
/// condition given twice, and conditions that leave the polynomial open or contradict each other
/// (such as velocities alone)
[[nodiscard]] Polynomial constrained_polynomial(std::span<const Condition> conditions);

}  // namespace viapoint
