/// @file
/// Linear segments joined by parabolic blends, over any number of points. Inner points are passed
/// by, not reached; the first and the last are reached at rest.
#pragma once

#include <span>
#include <vector>

#include "viapoint/profile/axis_law.hpp"

namespace viapoint {

/// Lines and blends, one blend a point and one linear part a segment.
struct BlendedLines {
  AxisLaw law;                             ///< from time 0
  std::vector<double> durations;           ///< of the segments, point to point [s], (k − 1,)
  std::vector<double> blend_acceleration;  ///< signed; 0 where there is nothing to blend, (k,)
  std::vector<double> blend_time;          ///< [s], (k,)
  std::vector<double> linear_velocity;     ///< signed, (k − 1,)
  std::vector<double> linear_time;         ///< [s], (k − 1,)
};

/// Segments of given durations (Craig 2005, eqs 7.24–7.29). Inner blends are centred on their
/// point's time; the first and the last lie wholly inside their segments.
/// @param points (k,), k >= 2; @param durations (k − 1,) [s]
/// @param accelerations magnitude in each blend, (k,), or (1,) for all [1/s²]
/// @param straight_at_middle segments whose blends must both be over at half time, see
/// pseudo_via_points()
/// @throws MotionError(kBadArgument) for sizes that do not fit and values that are not positive;
/// where an acceleration is too small to leave a linear part, `limit` is the least common
/// acceleration that works, and the message names it
[[nodiscard]] BlendedLines blended_lines(std::span<const double> points,
                                         std::span<const double> durations,
                                         std::span<const double> accelerations,
                                         std::span<const size_t> straight_at_middle = {});

/// Durations with which every linear part runs at its given speed: |Δq|/v, and half a blend v/(2a)
/// more for each end of the motion in the segment; 0 between equal points. For several axes take
/// the largest of each segment. Returns (k − 1,) [s].
/// @param speeds magnitude of the linear velocities, (k − 1,), or (1,) for all [1/s]
/// @throws MotionError(kBadArgument) as above, and for a speed that an end blend cannot reach
/// within its segment; the message names the largest that it can
[[nodiscard]] std::vector<double> durations_at_speed(std::span<const double> points,
                                                     std::span<const double> speeds,
                                                     std::span<const double> accelerations);

/// Three points and one blend of given half width, lines at full speed before and after:
/// w(t) = a τ²/2 + b τ + c with τ = t − T1 + ΔT on [T1 − ΔT, T1 + ΔT] (Taylor 1979).
/// @param before, after durations of the two segments, T1 and T2 [s]
/// @param half_width ΔT [s]
/// @throws MotionError(kBadArgument) unless 0 < half_width <= min(before, after)
[[nodiscard]] AxisLaw parabolic_blend(double w0, double w1, double w2, double before, double after,
                                      double half_width);

}  // namespace viapoint
