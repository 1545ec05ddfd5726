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

double hold_time(const Stretch& stretch, double from, double to) {
  double way = 0.0;
  for (const Quadrature& q : kGauss5) {
    const double u = (from + q.at * (to - from)) / stretch.length;
    way += q.weight * std::sqrt(square_at(stretch.tool->linear, u).value);
  }
  way *= (to - from) / stretch.length;
  return way / (kHoldAim * stretch.tool->limits.speed);
}

TimedSpan hold_span(size_t piece, const Stretch& stretch, double from, double to) {
  const auto state = [&](double sigma) {
    const NodeRate rate = hold_rate(stretch, sigma);
    return RateState{sigma, std::sqrt(rate.value), 0.5 * rate.slope};
  };
  return TimedSpan::between(piece, stretch.length, state(from), state(to),
                            hold_time(stretch, from, to));
}

bool holds_speed(const Stretch& stretch, const TimedSpan& span) {
  const double asked = stretch.tool->limits.speed;
  const SpeedRange range = tool_speed_range(span.u, span.duration, stretch.tool->linear, asked);
  return range.least >= asked * (1.0 - kHeldWithin) && range.most <= asked;
}

Grid refine_to_hold(const Course& course, Grid grid) {
  constexpr int kMostHalvings = 6;
  for (int halving = 0; halving < kMostHalvings; ++halving) {
    std::vector<bool> split;
    for (const Cell& cell : grid.cells) {
      const Stretch& stretch = course.stretches()[cell.piece];
      split.push_back(is_held(stretch) &&
                      !holds_speed(stretch, hold_span(cell.piece, stretch, cell.s0, cell.s1)));
    }
    split.front() = split.back() = false;
    if (std::none_of(split.begin(), split.end(), [](bool s) { return s; })) break;
    SquareRate rate;
    for (const double value : grid.square_rate) rate.push_back({value, 0.0});
    grid = refine(grid, split, rate);
  }
  return grid;
}

double largest_held_speed(const Course& course, const std::vector<TimedSpan>& spans) {
  double worst = 0.0;
  for (const TimedSpan& span : spans) {
    const Stretch& stretch = course.stretches()[span.piece];
    if (!is_held(stretch)) continue;
    const double asked = stretch.tool->limits.speed;
    const SpeedRange range = tool_speed_range(span.u, span.duration, stretch.tool->linear, asked);
    worst = std::max(worst, range.most / asked);
  }
  return worst;
}

}  // namespace viapoint::path_timing
