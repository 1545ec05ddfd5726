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

/// True where the first guess of a cell that is inside has the tool about as fast as it may be.
bool nears_ceiling(const Stretch& stretch, const Grid& grid, size_t k) {
  constexpr double kNear = 0.9;
  if (k == 0 || k + 1 == grid.cells.size() || !limits_speed(stretch)) return false;
  const Cell& cell = grid.cells[k];
  return cell.gear * cell.gear * grid.square_rate[k - 1] >=
             kNear * speed_ceiling(stretch, cell.s0).value ||
         grid.square_rate[k] >= kNear * speed_ceiling(stretch, cell.s1).value;
}

/// True where a span that has the speed at its ends exceeds it by no more than half of what is left
/// to it.
bool keeps_below(const Stretch& stretch, const TimedSpan& span) {
  ToolRate rate = stretch.tool->linear;
  rate.error = 0.0;  // the ceiling has it
  const double asked = stretch.tool->limits.speed;
  return tool_speed_range(span.u, span.duration, rate, asked).most <=
         asked * 0.5 * (1.0 + kHeldRoom);
}

}  // namespace

bool is_held(const Stretch& stretch) {
  return stretch.tool != nullptr && stretch.tool->limits.hold_speed;
}

bool limits_speed(const Stretch& stretch) {
  return stretch.tool != nullptr && std::isfinite(stretch.tool->limits.speed);
}

NodeRate speed_ceiling(const Stretch& stretch, double sigma) {
  const NodeRate hold = hold_rate(stretch, sigma);
  if (is_held(stretch)) return {hold.value * (2.0 - kHoldAim), hold.slope * (2.0 - kHoldAim)};
  const ToolRate& rate = stretch.tool->linear;
  const double value = std::sqrt(square_at(rate, sigma / stretch.length).value);
  const double room = value / (kHeldRoom * (value + rate.error));
  return {hold.value * room * room, hold.slope * room * room};
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
    for (size_t k = 0; k < grid.cells.size(); ++k) {
      const Cell& cell = grid.cells[k];
      const Stretch& stretch = course.stretches()[cell.piece];
      const bool held = is_held(stretch);
      if (!held && !nears_ceiling(stretch, grid, k)) {
        split.push_back(false);
        continue;
      }
      const TimedSpan span = hold_span(cell.piece, stretch, cell.s0, cell.s1);
      split.push_back(held ? !holds_speed(stretch, span) : !keeps_below(stretch, span));
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
