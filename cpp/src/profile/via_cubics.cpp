#include "viapoint/profile/via_cubics.hpp"

#include <string>

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
  return velocities;
}

std::vector<double> spline_velocities(std::span<const double> points,
                                      std::span<const double> durations, double first,
                                      double last) {
  require_path(points, durations);
  require_finite(first, "first");
  require_finite(last, "last");
  const std::vector<double> slopes = slopes_of(points, durations);
  // Equal q̈ on both sides of point i, times T_{i−1} T_i / 2:
  //   T_i v_{i−1} + 2 (T_{i−1} + T_i) v_i + T_{i−1} v_{i+1} = 3 (T_i s_{i−1} + T_{i−1} s_i),
  // solved from the front (Thomas): v_i = offset_i − share_i v_{i+1}.
  std::vector<double> velocities(points.size(), last);
  std::vector<double> share(points.size(), 0.0);
  velocities[0] = first;
  for (size_t i = 1; i < slopes.size(); ++i) {
    const double before = durations[i - 1], after = durations[i];
    const double right = 3.0 * (after * slopes[i - 1] + before * slopes[i]);
    const double pivot = 2.0 * (before + after) - after * share[i - 1];
    share[i] = before / pivot;
    velocities[i] = (right - after * velocities[i - 1]) / pivot;
  }
  for (size_t i = slopes.size() - 1; i >= 1; --i) velocities[i] -= share[i] * velocities[i + 1];
  return velocities;
}

}  // namespace viapoint
