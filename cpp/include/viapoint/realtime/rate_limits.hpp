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
  /// Brings the wished γ to the nearest one under which every limit is kept, for certain, for
  /// `time` [s] from a start with the slope stretch.slope.low, and then for less time, too. Without
  /// a joint that has to be pushed (for which γ = 0 would be too much) that is so for every γ
  /// between 0 and this one. stretch.path and stretch.rate have to hold all that the motion meets
  /// in that time; stretch.curvature does not count. False where there is none.
  [[nodiscard]] bool strongest(const RateStretch& stretch, double time,
                               double& curvature) const noexcept VIAPOINT_NONBLOCKING;

 private:
  [[nodiscard]] bool forced(const RateStretch& stretch, double time,
                            double& curvature) const noexcept VIAPOINT_NONBLOCKING;

  struct PairLimits {
    Eigen::Array2d acceleration, jerk;
  };
  std::size_t pairs_;
  std::array<PairLimits, kMaxJoints / 2> limits_;
};

}  // namespace viapoint
