/// @file
/// Cubics through via points, which are all reached: velocities there are given, taken from the
/// slopes, or chosen so that acceleration is continuous.
#pragma once

#include <span>
#include <vector>

#include "viapoint/profile/axis_law.hpp"

namespace viapoint {

/// One cubic a segment through points[i] with velocities[i], from time 0.
/// @param points (k,), k >= 2; @param durations (k − 1,) [s]; @param velocities (k,)
/// @throws MotionError(kBadArgument) for sizes that do not fit or durations that are not positive
[[nodiscard]] AxisLaw via_cubics(std::span<const double> points, std::span<const double> durations,
                                 std::span<const double> velocities);

/// Via velocities by the slope heuristic: 0 where the slope changes sign (or is zero on one side),
/// else the mean of the two slopes (Craig 2005, §7.3). First and last are given. Returns (k,).
[[nodiscard]] std::vector<double> slope_velocities(std::span<const double> points,
                                                   std::span<const double> durations,
                                                   double first = 0.0, double last = 0.0);

/// Via velocities that make acceleration continuous: the cubic spline with given end velocities
/// (clamped; de Boor 1978, ch. IV; tridiagonal, diagonally dominant). Returns (k,). For three
/// points these are the two cubics of the textbooks.
[[nodiscard]] std::vector<double> spline_velocities(std::span<const double> points,
                                                    std::span<const double> durations,
                                                    double first = 0.0, double last = 0.0);

/// The same with no acceleration at both ends, whatever velocities that takes (natural).
[[nodiscard]] std::vector<double> natural_spline_velocities(std::span<const double> points,
                                                            std::span<const double> durations);

/// The same with the velocity and the acceleration of the start at the end (periodic), so that the
/// motion can be repeated; the points need not close.
[[nodiscard]] std::vector<double> periodic_spline_velocities(std::span<const double> points,
                                                             std::span<const double> durations);

}  // namespace viapoint
