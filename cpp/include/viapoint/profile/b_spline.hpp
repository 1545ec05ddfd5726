/// @file
/// Laws drawn by control points: Bézier and B-spline. The control points are not reached, but for
/// the first and the last; the law stays within their hull.
#pragma once

#include <span>
#include <vector>

#include "viapoint/profile/axis_law.hpp"

namespace viapoint {

/// q(t) = Σ B_{i,n}((t − t0)/(t1 − t0)) P_i, of degree n = k − 1 (Farin 2002, ch. 5; Biagiotti &
/// Melchiorri 2008, §B.3). It leaves the first point toward the second.
/// @param points (k,), 2 <= k <= 12
/// @throws MotionError(kBadArgument) for another k, values that are not finite, t0 >= t1
[[nodiscard]] AxisLaw bezier(std::span<const double> points, double t0, double t1);

/// q(t) = Σ N_{i,p}(t) P_i, piecewise of degree p with p − 1 continuous derivatives at a simple
/// knot (de Boor 1978, ch. IX; Biagiotti & Melchiorri 2008, §B.1).
/// @param points (k,), k > p
/// @param knots (k + p + 1,) [s], not falling; the law runs from knots[p] to knots[k]. A knot may
/// come up to p times inside: each time costs one continuous derivative
/// @param degree p, 1 to 5
/// @throws MotionError(kBadArgument) for sizes or knots that do not fit, values that are not finite
[[nodiscard]] AxisLaw b_spline(std::span<const double> points, std::span<const double> knots,
                               int degree);

/// The knots from t0 to t1 with both ends p + 1 times and equal spans between: the law begins at
/// the first and ends at the last of `points` control points. Returns (points + p + 1,) [s].
/// @throws MotionError(kBadArgument) for fewer points than p + 1, t0 >= t1
[[nodiscard]] std::vector<double> clamped_knots(size_t points, int degree, double t0, double t1);

/// Control points and knots of the B-spline through points at times, the sum of durations from 0.
struct InterpolatingSpline {
  std::vector<double> control_points;  ///< (k + p − 1,)
  std::vector<double> knots;           ///< (k + 2p,) [s]
};

/// The spline of degree 3 or 5 that passes every point at its time and meets velocities (3), or
/// velocities and accelerations (5), at both ends; acceleration (3) or the fourth derivative (5)
/// is continuous (Biagiotti & Melchiorri 2008, §4.5). Knots lie at the points' times.
/// @param points (k,), k >= 2; @param durations (k − 1,) [s]
/// @param first, last velocity and acceleration at the ends; position and jerk are not read
/// @throws MotionError(kBadArgument) for another degree, sizes that do not fit, durations that are
/// not positive
[[nodiscard]] InterpolatingSpline spline_through(std::span<const double> points,
                                                 std::span<const double> durations, int degree,
                                                 const AxisState& first, const AxisState& last);

}  // namespace viapoint
