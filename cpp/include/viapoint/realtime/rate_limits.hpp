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
/// of, and where it begins.
struct RateStretch {
  PathStretch path;
  Range rate;              ///< ρ, within [0, 1]
  Range slope;             ///< α = dρ/dt [1/s]
  double curvature = 0.0;  ///< γ = dα/dt [1/s²]
  double first_rate = 0.0, first_slope = 0.0;
  double time = 0.0;  ///< it takes [s], > 0

  void begin(double rate_there, double slope_there, double takes) noexcept {
    first_rate = rate_there;
    first_slope = slope_there;
    time = takes;
  }
};

/// The limits of acceleration and jerk on q̈ = q''ρ² + q'α and q⃛ = q'''ρ³ + 3q''ρα + q'γ, by
/// interval arithmetic (Moore 1966), so that what holds for the ranges holds for every moment of
/// the stretch. That q̈ is kept is proven in one of two ways: by the ranges of what it is made of,
/// or by how far the jerk can take it from what it is at the start. The first is the closer one
/// where the jerk is large, the second where the jerk is small and the acceleration at its limit,
/// as ρ² and α change against each other there. Real-time: all but the constructor is safe.
/// Threads: any, it is constant.
class RateLimits {
 public:
  explicit RateLimits(const JointLimits& limits);

  /// True where every limit is kept, for certain, anywhere in the stretch.
  [[nodiscard]] bool kept(const RateStretch& stretch) const noexcept VIAPOINT_NONBLOCKING;
  /// Brings the wished γ to the nearest one under which every limit is kept, for certain, for
  /// stretch.time, and then for less time, too. Without a joint that has to be pushed (for which
  /// γ = 0 would be too much) that is so for every γ between 0 and this one. stretch.path and
  /// stretch.rate have to hold all that the motion meets in that time; stretch.slope and
  /// stretch.curvature do not count. False where there is none.
  [[nodiscard]] bool strongest(const RateStretch& stretch,
                               double& curvature) const noexcept VIAPOINT_NONBLOCKING;

 private:
  [[nodiscard]] bool forced(const RateStretch& stretch,
                            double& curvature) const noexcept VIAPOINT_NONBLOCKING;

  struct PairLimits {
    Eigen::Array2d acceleration, jerk;
  };
  std::size_t pairs_;
  std::array<PairLimits, kMaxJoints / 2> limits_;
};

}  // namespace viapoint
