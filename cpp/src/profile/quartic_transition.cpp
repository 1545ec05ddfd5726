#include "viapoint/profile/quartic_transition.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "profile/argument_check.hpp"

namespace viapoint {
namespace {

/// What is left of a segment's line below this share of it is rounding.
constexpr double kTimeRounding = 1e-12;

}  // namespace

Polynomial::Coefficients quartic_transition(double from, double to, double duration, double t_acc) {
  const double k = to * t_acc / duration + from;
  const double rate = 0.5 / t_acc;  // of h
  const double cube = rate * rate * rate;
  return {from, -2.0 * from * rate, 0.0, 2.0 * k * cube, -k * cube * rate};
}

void check_transitions(size_t points, std::span<const double> durations, double t_acc) {
  require_segments(points, durations.size(), "durations");
  require_positive(durations, "durations");
  if (points == 2) return;  // a line alone has no transition
  require_positive(t_acc, "t_acc");
  double most = std::numeric_limits<double>::infinity();
  size_t tightest = 0;
  for (size_t i = 0; i < durations.size(); ++i) {
    const bool at_one_end = i == 0 || i + 1 == durations.size();
    const double room = at_one_end ? durations[i] : 0.5 * durations[i];
    if (room < most) most = room, tightest = i;
  }
  if (t_acc <= most) return;
  refuse("t_acc is " + written(t_acc) + " s, but segment " + std::to_string(tightest) + " of " +
             written(durations[tightest]) + " s leaves room for at most " + written(most) + " s",
         t_acc, most,
         {"make t_acc smaller", "give segment " + std::to_string(tightest) + " more time"});
}

AxisLaw quartic_transitions(std::span<const double> points, std::span<const double> durations,
                            double t_acc) {
  check_transitions(points.size(), durations, t_acc);
  require_finite(points, "points");
  std::vector<Polynomial> parts;
  double point_time = 0.0;  // at which the line of segment i leaves points[i]
  for (size_t i = 0; i < durations.size(); ++i) {
    const double slope = (points[i + 1] - points[i]) / durations[i];
    const bool turns_before = i > 0, turns_after = i + 1 < durations.size();
    const double begin = turns_before ? point_time + t_acc : point_time;
    const double end = point_time + durations[i] - (turns_after ? t_acc : 0.0);
    if (turns_before) {
      const double from = (points[i - 1] - points[i]) * t_acc / durations[i - 1];
      Polynomial turn{point_time - t_acc, begin, {}};
      turn.c = quartic_transition(from, points[i + 1] - points[i], durations[i], t_acc);
      turn.c[0] += points[i];
      parts.push_back(turn);
    }
    if (end - begin > kTimeRounding * durations[i]) {
      parts.push_back({begin, end, {points[i] + slope * (begin - point_time), slope}});
    }
    point_time += durations[i];
  }
  return AxisLaw(std::move(parts));
}

}  // namespace viapoint
