/// @file
/// What a change of the rate asks of the joints, and how much of it they allow.
#pragma once

#include <array>
#include <cstddef>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/lookahead.hpp"

namespace viapoint {

/// A stretch of time with a constant γ: the ranges of everything that the joints' motion is made
/// of. The rate's is within [0, 1].
struct RateStretch {
  DerivativeRanges path;
  Range rate;              ///< ρ
  Range slope;             ///< α = dρ/dt [1/s]
  double curvature = 0.0;  ///< γ = dα/dt [1/s²]
};

/// The limits of acceleration and jerk on q̈ = q''ρ² + q'α and q⃛ = q'''ρ³ + 3q''ρα + q'γ, by
/// interval arithmetic (Moore 1966), so that what holds for the ranges
/// holds for every moment of the stretch. Real-time: all but the constructor is safe. Threads: any,
/// it is constant.
class RateLimits {
 public:
  explicit RateLimits(const JointLimits& limits);

  /// True where every limit is kept, for certain, anywhere in the stretch.
  [[nodiscard]] bool kept(const RateStretch& stretch) const noexcept VIAPOINT_NONBLOCKING;
  /// Narrows γ to what may keep every limit for `time` [s] from a start with the slope
  /// stretch.slope.low: those of the jerk all the while, that of the acceleration at the end, which
  /// at the start no γ changes. kept() has the last word. stretch.rate has to hold the rates of
  /// that time. False where there is none.
  [[nodiscard]] bool room(const RateStretch& stretch, double time,
                          Range& curvature) const noexcept VIAPOINT_NONBLOCKING;

 private:
  struct PairLimits {
    Eigen::Array2d acceleration, jerk;
  };
  std::size_t pairs_;
  std::array<PairLimits, kMaxJoints / 2> limits_;
};

}  // namespace viapoint
