#include "viapoint/profile/pseudo_via_points.hpp"

#include <string>

#include "profile/argument_check.hpp"

namespace viapoint {
namespace {

void require_inner(const ThroughPoint& point, size_t points, size_t least) {
  if (point.index >= least && point.index + 1 < points) return;
  refuse("through point " + std::to_string(point.index) + " must be an inner point, from 1 to " +
             std::to_string(points - 2) + ", and come once, in rising order",
         static_cast<double>(point.index), static_cast<double>(points - 2));
}

}  // namespace

PseudoViaPoints pseudo_via_points(std::span<const double> points, std::span<const double> durations,
                                  std::span<const ThroughPoint> through) {
  require_segments(points.size(), durations.size(), "durations");
  require_finite(points, "points");
  require_positive(durations, "durations");
  PseudoViaPoints result;
  std::vector<double> left(durations.begin(), durations.end());
  size_t least = 1;
  for (const ThroughPoint& point : through) {
    require_inner(point, points.size(), least);
    require_finite(point.velocity, "velocity at a through point");
    require_positive(point.half_gap, "half_gap");
    left[point.index - 1] -= point.half_gap;
    left[point.index] -= point.half_gap;
    least = point.index + 1;
  }
  for (size_t i = 0; i < left.size(); ++i) {
    if (left[i] > 0.0) continue;
    refuse("the pseudo via points leave " + written(left[i]) + " s of segment " +
               std::to_string(i) + ", which lasts " + written(durations[i]) +
               " s; something must be left",
           left[i], 0.0, {"give a smaller half_gap"});
  }
  auto next = through.begin();
  for (size_t i = 0; i < points.size(); ++i) {
    if (next != through.end() && next->index == i) {
      const double reach = next->velocity * next->half_gap;
      result.middles.push_back(result.points.size());
      result.points.insert(result.points.end(), {points[i] - reach, points[i] + reach});
      result.source.insert(result.source.end(), {i, i});
      result.durations.push_back(2.0 * next->half_gap);
      ++next;
    } else {
      result.points.push_back(points[i]);
      result.source.push_back(i);
    }
    if (i < left.size()) result.durations.push_back(left[i]);
  }
  return result;
}

}  // namespace viapoint
