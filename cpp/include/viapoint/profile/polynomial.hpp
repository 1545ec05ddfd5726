/// @file
/// One axis as a polynomial of time: the cubic and the quintic between two boundary states, and
/// where a polynomial is largest. A polynomial that starts or ends at speed can leave the interval
/// between its end points, so limits are held against its extremes, never against its ends.
#pragma once

#include <array>

#include "viapoint/profile/jerk_profile.hpp"

namespace viapoint {

/// Smallest and largest value of one quantity over a stretch of time, and when each is reached.
struct Extremes {
  double low = 0.0, low_time = 0.0;    ///< [unit of the quantity], [s]
  double high = 0.0, high_time = 0.0;  ///< [unit of the quantity], [s]
};

/// q(t) = Σ c[k] (t − t0)^k, meant for t in [t0, t1].
struct Polynomial {
  static constexpr int kMaxDegree = 11;
  using Coefficients = std::array<double, kMaxDegree + 1>;

  double t0 = 0.0, t1 = 0.0;  ///< [s], t0 < t1
  Coefficients c{};

  /// State at t; beyond [t0, t1] the same polynomial goes on. Real-time: safe.
  [[nodiscard]] AxisState at(double t) const;
  /// Extremes over [t0, t1] of q (derivative 0), q̇ (1), q̈ (2) or q⃛ (3), found at the ends and at
  /// the real roots of the next derivative. Real-time: safe.
  /// @pre 0 <= derivative <= 3
  [[nodiscard]] Extremes extremes(int derivative) const;
};

/// Holds a law against the position it was made to end at: coefficients of very long or very short
/// times leave what doubles hold. @throws MotionError(kBadArgument) unless it ends there
void require_arrival(const Polynomial& law, double end);

/// The cubic with the given q and q̇ at both ends (Craig 2005, eq. 7.11). `t0` may be any time.
/// @throws MotionError(kBadArgument) unless all is finite and t0 < t1
[[nodiscard]] Polynomial cubic(const AxisState& from, const AxisState& to, double t0, double t1);

/// The quintic with the given q, q̇ and q̈ at both ends (Craig 2005, eq. 7.18).
/// @throws MotionError(kBadArgument) unless all is finite and t0 < t1
[[nodiscard]] Polynomial quintic(const AxisState& from, const AxisState& to, double t0, double t1);

}  // namespace viapoint
