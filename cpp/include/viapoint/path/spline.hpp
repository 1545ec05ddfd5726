/// @file
/// C² curves of any dimension through or by points, as chains of quintics: joints of an arm, points
/// of its tool, rotation vectors.
#pragma once

#include <span>
#include <vector>

#include "viapoint/path/joint_path.hpp"

namespace viapoint {

/// Value, first and second derivative of the natural interpolating spline at each of its knots: of
/// all functions through the points, degree 3 has the least ∫‖f''‖² (C², f'' = 0 at the ends) and
/// degree 5 the least ∫‖f'''‖² (C⁴, f''' = f'''' = 0 at the ends) (Schoenberg 1964; de Boor 1978,
/// ch. V). Two points give the straight line.
/// @param points at least 2, of equal size; @param at where each is passed, rising
/// @param degree 3 or 5
/// @throws MotionError(kBadArgument) for other arguments. Real-time: not. Threads: any.
[[nodiscard]] std::vector<PathPoint> natural_spline(std::span<const JointVector> points,
                                                    std::span<const double> at, int degree);

/// Quintics from knot to knot (Hermite). A polynomial of degree 5 or less through the knots is
/// reproduced. @param at where the knots are, rising from 0
[[nodiscard]] JointPath quintic_chain(std::span<const PathPoint> knots, std::span<const double> at);

/// Clamped B-spline with uniform knots over [0, length]: begins at the first control point and ends
/// at the last; with degree + 1 control points it is the Bézier curve (de Boor 1978, ch. IX).
/// @param control degree + 1 points or more; @param degree 3 to 5 (C² needs 3), or any up to 5
/// where degree + 1 points make one piece
/// @throws MotionError(kBadArgument)
[[nodiscard]] JointPath b_spline_path(std::span<const JointVector> control, int degree,
                                      double length);
/// Where each control point of that B-spline acts most, its Greville abscissa: the mean of `degree`
/// successive knots, from 0 to `length`.
[[nodiscard]] std::vector<double> greville_abscissae(size_t control, int degree, double length);

/// A lower bound, over the whole path, of ‖q'‖ as a share of its mean: what is near 0 has a cusp,
/// where the direction jumps. Proven by Taylor expansion on halved intervals; not refined above
/// `enough`.
struct SlowestPlace {
  double share = 0.0;  ///< of the length over the parameter's range
  double s = 0.0;      ///< where
};
[[nodiscard]] SlowestPlace slowest_place(const JointPath& path, double enough);

}  // namespace viapoint
