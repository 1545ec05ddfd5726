/// @file
/// The quickest motion from rest to rest.
///
/// With H = (1/j_up + 1/j_down)/2 as in the upward family, of which it is a member, a side that
/// reaches the top velocity u without holding its acceleration peaks at √(u/H) and covers
/// u √(u/H) (1/j_up + 2/j_down)/3; one that holds its limit c (where u > H c²) covers
/// u²/2c + u c/2j_down + H c³ (1/j_up − 1/j_down)/12. Both sides together cover the distance, or
/// what is left is a cruise at the velocity limit: for u a cube root, a quadratic, or, where only
/// one side holds, the one root of a quartic.
#pragma once

#include "profile/upward_family.hpp"
#include "viapoint/profile/axis_move.hpp"

namespace viapoint {

/// Of a motion that goes up. Not initialised: many wait in arrays. Real-time: safe.
class RestMotion {
 public:
  // NOLINTNEXTLINE(modernize-use-equals-default): that would have it filled with zeros first
  RestMotion() noexcept {}

  /// @pre distance > 0
  void solve(double distance, const UpwardLimits& limits) noexcept;
  [[nodiscard]] double duration() const noexcept { return duration_; }
  /// Writes the motion from `from` to `to`, up (`sign` 1) or down (−1), in that many times its
  /// duration. @pre solved
  void write(double from, double to, double sign, double stretch, AxisMove& move) const noexcept;

 private:
  /// One of both ramps, counted from the end at rest; times are counted outwards, too.
  struct Side {
    double peak, hold;
  };
  struct Course;

  /// How a side with that limit of acceleration gets to the top velocity, and how far.
  [[nodiscard]] Side side(double top, double cap) const noexcept;
  [[nodiscard]] double length(double top, double cap) const noexcept;
  [[nodiscard]] double top_of_both(double distance) const noexcept;
  [[nodiscard]] double top_of_one(double distance, double cap, double highest) const noexcept;

  UpwardLimits limits_;
  double per_up_, per_down_, half_;  ///< 1/jerk, H
  Side rise_, fall_;
  double top_, cruise_, duration_;
};

}  // namespace viapoint
