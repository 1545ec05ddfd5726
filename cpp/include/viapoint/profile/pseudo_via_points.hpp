/// @file
/// Through points of lines with parabolic blends. A blend passes its point by; where the motion
/// shall go exactly through a point, two pseudo via points take its place, one before and one after
/// on a line through it, so that it lies on the linear part between their blends.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace viapoint {

/// A point to go through at its time.
struct ThroughPoint {
  size_t index = 0;       ///< of the point; neither the first nor the last
  double velocity = 0.0;  ///< there [1/s]
  double half_gap = 0.0;  ///< time from either pseudo via point to the point [s]
};

/// Points and durations with every through point replaced by two.
struct PseudoViaPoints {
  std::vector<double> points;     ///< (k + m,) for m through points
  std::vector<double> durations;  ///< (k + m − 1,) [s]
  std::vector<size_t> source;     ///< the original index of each point, (k + m,)
  std::vector<size_t> middles;    ///< segments with a through point at half time, (m,)
};

/// (Craig 2005, §7.3.) Give `points`, `durations` and `middles` to blended_lines().
/// @param points (k,); @param durations (k − 1,) [s]
/// @param through in rising order of index
/// @throws MotionError(kBadArgument) for sizes that do not fit, an index that is not an inner
/// point's, half gaps that are not positive or leave nothing of a segment
[[nodiscard]] PseudoViaPoints pseudo_via_points(std::span<const double> points,
                                                std::span<const double> durations,
                                                std::span<const ThroughPoint> through);

}  // namespace viapoint
