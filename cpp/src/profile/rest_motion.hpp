/// @file
/// The quickest motion from rest to rest, in closed form.
///
/// With H = (1/j_up + 1/j_down)/2 as in the upward family, of which it is a member, a side that
/// reaches the top velocity u without holding its acceleration peaks at √(u/H) and covers
/// u √(u/H) (1/j_up + 2/j_down)/3; one that holds its limit c (where u > H c²) covers
/// u²/2c + u c/2j_down + H c³ (1/j_up − 1/j_down)/12. Both sides together cover the distance, or
/// what is left is a cruise at the velocity limit: a cube root or a quadratic for u. Where only one
/// side holds it is a quartic, which is left to the family.
#pragma once

#include "profile/upward_family.hpp"
#include "viapoint/profile/axis_move.hpp"

namespace viapoint {

/// Of a motion that goes up. Not initialised: many wait in arrays. Real-time: safe.
class RestMotion {
 public:
  // NOLINTNEXTLINE(modernize-use-equals-default): that would have it filled with zeros first
  RestMotion() noexcept {}

  /// @return false where exactly one of both acceleration limits is reached
  /// @pre distance > 0
  [[nodiscard]] bool solve(double distance, const UpwardLimits& limits) noexcept;
  [[nodiscard]] double duration() const noexcept { return duration_; }
  /// Writes the motion from `from` to `to`, up (`sign` 1) or down (−1), in that many times its
  /// duration. @pre solve() returned true
  void write(double from, double to, double sign, double stretch, AxisMove& move) const noexcept;

 private:
  /// One of both ramps, counted from the end at rest; times are counted outwards, too.
  struct Side {
    double peak, hold;
  };
  struct Course;

  [[nodiscard]] double free_length(double top, double peak) const noexcept;
  void set_held(double top) noexcept;

  UpwardLimits limits_;
  double per_up_, per_down_, half_;  ///< 1/jerk, H
  Side rise_, fall_;
  double top_, cruise_, duration_;
};

}  // namespace viapoint
