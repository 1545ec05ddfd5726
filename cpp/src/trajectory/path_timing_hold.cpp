#include "trajectory/path_timing_hold.hpp"

#include <algorithm>
#include <cmath>

#include "trajectory/path_timing_places.hpp"
#include "viapoint/trajectory/tool_certificate.hpp"

namespace viapoint::path_timing {
namespace {

/// ‖p'‖² and half its slope by u.
struct Square {
  double value = 0.0, half_slope = 0.0;
};

Square square_at(const ToolRate& rate, double u) {
  Square square;
  for (const auto& c : rate.coefficients) {
    const double w = c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5]))));
    const double w1 = c[1] + u * (2 * c[2] + u * (3 * c[3] + u * (4 * c[4] + u * 5 * c[5])));
    square.value += w * w;
    square.half_slope += w * w1;
  }
  return square;
}

}  // namespace

bool is_held(const Stretch& stretch) {
  return stretch.tool != nullptr && stretch.tool->limits.hold_speed;
}

NodeRate hold_rate(const Stretch& stretch, double sigma) {
  const double l = stretch.length, v = kHoldAim * stretch.tool->limits.speed;
  const Square square = square_at(stretch.tool->linear, sigma / l);
  const double b = v * v * l * l / square.value;
  return {b, -2.0 * b * square.half_slope / square.value / l};
}

TimedSpan hold_span(size_t piece, const Stretch& stretch, double from, double to) {
  double way = 0.0;
  for (const Quadrature& q : kGauss5) {
    const double u = (from + q.at * (to - from)) / stretch.length;
    way += q.weight * std::sqrt(square_at(stretch.tool->linear, u).value);
  }
  way *= (to - from) / stretch.length;
  const auto state = [&](double sigma) {
    const NodeRate rate = hold_rate(stretch, sigma);
    return RateState{sigma, std::sqrt(rate.value), 0.5 * rate.slope};
  };
  return TimedSpan::between(piece, stretch.length, state(from), state(to),
                            way / (kHoldAim * stretch.tool->limits.speed));
}

bool holds_speed(const Stretch& stretch, const TimedSpan& span) {
  const SpeedRange range = tool_speed_range(span.u, span.duration, stretch.tool->linear);
  const double asked = stretch.tool->limits.speed;
  return range.least >= asked * (1.0 - kHeldWithin) && range.most <= asked;
}

double largest_held_speed(const Course& course, const std::vector<TimedSpan>& spans) {
  double worst = 0.0;
  for (const TimedSpan& span : spans) {
    const Stretch& stretch = course.stretches()[span.piece];
    if (!is_held(stretch)) continue;
    const SpeedRange range = tool_speed_range(span.u, span.duration, stretch.tool->linear);
    worst = std::max(worst, range.most / stretch.tool->limits.speed);
  }
  return worst;
}

}  // namespace viapoint::path_timing
