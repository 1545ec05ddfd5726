/// @file
/// Motion of one axis in constant-jerk phases.
#pragma once

#include <array>

namespace viapoint {

/// Position and derivatives of one axis.
struct AxisState {
  double q = 0.0, qd = 0.0, qdd = 0.0, qddd = 0.0;
};

/// At most seven phases of constant jerk from a start state.
struct JerkProfile {
  std::array<double, 7> duration{};  ///< [s], each >= 0
  std::array<double, 7> jerk{};      ///< [1/s³]
  AxisState start;
  int phases = 0;

  [[nodiscard]] double total() const;
  /// State at t, clamped to [0, total()]. Real-time: safe.
  [[nodiscard]] AxisState at(double t) const;
};

/// The quickest rest-to-rest move over `distance` (either sign) under |v|, |a|, |j| limits: up to
/// seven phases, fewer where a limit is not reached (Biagiotti & Melchiorri 2008, §3.4).
/// @pre limits > 0 and finite. Real-time: safe.
[[nodiscard]] JerkProfile rest_to_rest(double distance, double velocity, double acceleration,
                                       double jerk);

}  // namespace viapoint
