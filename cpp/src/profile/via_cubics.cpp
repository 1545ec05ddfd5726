#include "viapoint/profile/via_cubics.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "profile/argument_check.hpp"

namespace viapoint {
namespace {

void require_path(std::span<const double> points, std::span<const double> durations) {
  require_segments(points.size(), durations.size(), "durations");
  require_finite(points, "points");
  require_positive(durations, "durations");
}

std::vector<double> slopes_of(std::span<const double> points, std::span<const double> durations) {
  std::vector<double> slopes;
  for (size_t i = 0; i < durations.size(); ++i) {
    slopes.push_back((points[i + 1] - points[i]) / durations[i]);
  }
  return slopes;
}

/// @throws MotionError(kBadArgument) where slopes or durations were too far apart for doubles
std::vector<double> representable(std::vector<double> velocities) {
  for (const double v : velocities) {
    if (std::isfinite(v)) continue;
    refuse("a via velocity would be " + written(v) + "; points or durations are too far apart", v,
           0.0, {"give points or durations nearer to one another"});
  }
  return velocities;
}

/// A condition on the velocity at an end: v_end + share · v_next = value.
struct EndCondition {
  double share, value;
};

/// Equal q̈ on both sides of each inner point i, times T_{i−1} T_i / 2:
///   T_i v_{i−1} + 2 (T_{i−1} + T_i) v_i + T_{i−1} v_{i+1} = 3 (T_i s_{i−1} + T_{i−1} s_i),
/// divided by T_{i−1} + T_i and solved from the front (Thomas): v_i = offset_i − share_i v_{i+1}.
std::vector<double> solved(const std::vector<double>& slopes, std::span<const double> durations,
                           EndCondition first, EndCondition last) {
  const size_t end = slopes.size();
  std::vector<double> velocities(end + 1, 0.0), share(end + 1, 0.0);
  velocities[0] = first.value;
  share[0] = first.share;
  for (size_t i = 1; i < end; ++i) {
    const double weight = durations[i - 1] / (durations[i - 1] + durations[i]);
    const double right = 3.0 * ((1.0 - weight) * slopes[i - 1] + weight * slopes[i]);
    const double pivot = 2.0 - (1.0 - weight) * share[i - 1];
    share[i] = weight / pivot;
    velocities[i] = (right - (1.0 - weight) * velocities[i - 1]) / pivot;
  }
  velocities[end] =
      (last.value - last.share * velocities[end - 1]) / (1.0 - last.share * share[end - 1]);
  for (size_t i = end; i-- > 0;) velocities[i] -= share[i] * velocities[i + 1];
  return velocities;
}

}  // namespace

AxisLaw via_cubics(std::span<const double> points, std::span<const double> durations,
                   std::span<const double> velocities) {
  require_path(points, durations);
  require_finite(velocities, "velocities");
  if (velocities.size() != points.size()) {
    refuse(std::to_string(points.size()) + " points need as many velocities, but " +
               std::to_string(velocities.size()) + " were given",
           static_cast<double>(velocities.size()), static_cast<double>(points.size()));
  }
  std::vector<Polynomial> parts;
  double t = 0.0;
  for (size_t i = 0; i < durations.size(); ++i) {
    const AxisState from{points[i], velocities[i], 0.0, 0.0};
    const AxisState to{points[i + 1], velocities[i + 1], 0.0, 0.0};
    parts.push_back(cubic(from, to, t, t + durations[i]));
    t += durations[i];
  }
  return AxisLaw(std::move(parts));
}

std::vector<double> slope_velocities(std::span<const double> points,
                                     std::span<const double> durations, double first, double last) {
  require_path(points, durations);
  require_finite(first, "first");
  require_finite(last, "last");
  const std::vector<double> slopes = slopes_of(points, durations);
  std::vector<double> velocities{first};
  for (size_t i = 1; i < slopes.size(); ++i) {
    const bool goes_on = slopes[i - 1] * slopes[i] > 0.0;
    velocities.push_back(goes_on ? 0.5 * (slopes[i - 1] + slopes[i]) : 0.0);
  }
  velocities.push_back(last);
  return representable(std::move(velocities));
}

std::vector<double> spline_velocities(std::span<const double> points,
                                      std::span<const double> durations, double first,
                                      double last) {
  require_path(points, durations);
  require_finite(first, "first");
  require_finite(last, "last");
  return representable(solved(slopes_of(points, durations), durations, {0.0, first}, {0.0, last}));
}

std::vector<double> natural_spline_velocities(std::span<const double> points,
                                              std::span<const double> durations) {
  require_path(points, durations);
  const std::vector<double> slopes = slopes_of(points, durations);
  // No q̈ at the end of a segment: its velocity and half the one across make 3/2 of its slope.
  return representable(
      solved(slopes, durations, {0.5, 1.5 * slopes.front()}, {0.5, 1.5 * slopes.back()}));
}

std::vector<double> periodic_spline_velocities(std::span<const double> points,
                                               std::span<const double> durations) {
  require_path(points, durations);
  const std::vector<double> slopes = slopes_of(points, durations);
  // The splines with the velocity x at both ends are at_rest + x · unit; x closes the gap in q̈.
  const std::vector<double> none(slopes.size(), 0.0);
  const std::vector<double> at_rest = solved(slopes, durations, {0.0, 0.0}, {0.0, 0.0});
  const std::vector<double> unit = solved(none, durations, {0.0, 1.0}, {0.0, 1.0});
  const size_t last = slopes.size();
  const double share = durations.front() / (durations.front() + durations.back());
  const auto gap = [&](const std::vector<double>& v, double first_slope, double last_slope) {
    return share * (2.0 * v[last] + v[last - 1] - 3.0 * last_slope) +
           (1.0 - share) * (2.0 * v[0] + v[1] - 3.0 * first_slope);
  };
  const double x = -gap(at_rest, slopes.front(), slopes.back()) / gap(unit, 0.0, 0.0);
  std::vector<double> velocities;
  for (size_t i = 0; i <= last; ++i) velocities.push_back(at_rest[i] + x * unit[i]);
  return representable(std::move(velocities));
}

}  // namespace viapoint
