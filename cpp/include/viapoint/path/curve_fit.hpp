/// @file
/// Any curve as a C² spline: poses on it, chosen so that the spline through them stays near it.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "viapoint/core/pose.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint {

/// Poses on a curve. The natural cubic spline through their positions and the orientation spline
/// through their rotations, both placed at `at`, are the fit.
struct CurveFit {
  std::vector<double> at;   ///< parameter of each pose, rising
  std::vector<Pose> poses;  ///< as many
  Deviation deviation;      ///< largest of the places that were looked at; no bound
  size_t looked_at = 0;     ///< how many places of the curve
};

/// Fits a curve that can be asked anywhere: spans of the spline are halved until it is within the
/// tolerances of gamma at eight places inside every one, at equal parameter.
/// @param gamma pose at a parameter in [from, to]; may throw, which ends the fit
/// @throws MotionError(kDegenerateCurve) with `share` where no number of poses is enough (a jump),
/// kBadArgument. Real-time: not. Threads: that of gamma.
[[nodiscard]] CurveFit fit_curve(const std::function<Pose(double)>& gamma, double from, double to,
                                 const Deviation& tolerance);
/// Fits samples of a curve: leaves out those that the spline through the others comes within the
/// tolerances of.
/// @param at parameter of each sample, rising
[[nodiscard]] CurveFit fit_curve(std::span<const Pose> samples, std::span<const double> at,
                                 const Deviation& tolerance);

}  // namespace viapoint
