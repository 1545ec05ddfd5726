#include "trajectory/path_timing_span.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trajectory/path_timing_tool.hpp"
#include "trajectory/rate_bounds.hpp"
#include "viapoint/core/bernstein_bounds.hpp"

namespace viapoint::path_timing {
namespace {

/// A bound of |Σ c_k x^k| on [0, 1], relatively no more than `slack` above what is reached.
template <size_t Size>
double magnitude(const std::array<double, Size>& c, double slack) {
  std::array<double, Size> b = to_bernstein(c);
  double scale = std::max(std::abs(b.front()), std::abs(b.back())), hull = 0.0;
  for (double value : b) hull = std::max(hull, std::abs(value));
  if (hull <= scale * (1.0 + slack)) return hull;
  const double gap = slack * std::max(scale, 0.1 * hull);
  const double above = largest_value(b, scale, gap);
  for (double& value : b) value = -value;
  return largest_value(b, above, gap);
}

/// Shares of a motion straight along σ = length · u, from the extrema of u̇, ü, u⃛.
Shares straight_shares(const TimedSpan& span, const Stretch& stretch, double slack) {
  const auto& c = span.u;
  const double per_second = 1.0 / span.duration;
  const double first = stretch.length * per_second, second = first * per_second;
  const double third = second * per_second;
  return {magnitude<5>({c[1], 2 * c[2], 3 * c[3], 4 * c[4], 5 * c[5]}, slack) * first /
              stretch.rate_limit,
          magnitude<4>({2 * c[2], 6 * c[3], 12 * c[4], 20 * c[5]}, slack) * second /
              stretch.change_limit,
          magnitude<3>({6 * c[3], 24 * c[4], 60 * c[5]}, slack) * third / stretch.jerk_limit};
}

/// The motion q(u(t)) of all joints, and of the tool, against their limits, over `cells` parts of
/// the span.
ShareBounds curved_shares(const Course& course, const TimedSpan& span, int cells) {
  const Stretch& stretch = course.stretches()[span.piece];
  const auto& q = stretch.geometry->coefficients;
  ShareBounds bounds;
  const int groups = (cells + TimingSamples::kMostParts - 1) / TimingSamples::kMostParts;
  for (int group = 0; group < groups; ++group) {
    const TimingSamples samples(span.u, span.duration, cells / groups,
                                static_cast<double>(group) / groups,
                                static_cast<double>(group + 1) / groups);
    for (int i = 0; i < course.joints(); ++i) {
      const Quintic path{q(0, i), q(1, i), q(2, i), q(3, i), q(4, i), q(5, i)};
      const Rates reached = samples.reached(path), between = samples.between(path);
      const Shares per = course.shares_per_rate(span.piece, i);
      bounds.reached.include({reached.velocity * per.velocity,
                              reached.acceleration * per.acceleration, reached.jerk * per.jerk});
      bounds.proven.include({(reached.velocity + between.velocity) * per.velocity,
                             (reached.acceleration + between.acceleration) * per.acceleration,
                             (reached.jerk + between.jerk) * per.jerk});
    }
    if (stretch.tool != nullptr) {
      const ToolBounds tool = tool_bounds(*stretch.tool, samples);
      bounds.reached.include(tool.reached);
      bounds.proven.include(tool.proven);
    }
  }
  return bounds;
}

}  // namespace

TimedSpan TimedSpan::between(size_t piece, double length, const RateState& from,
                             const RateState& to, double duration) {
  const double u0 = from.s / length;
  const double a1 = from.rate * duration / length;
  const double a2 = 0.5 * from.change * duration * duration / length;
  const double gap = (to.s - from.s) / length - a1 - a2;
  const double slope = to.rate * duration / length - a1 - 2.0 * a2;
  const double bend = to.change * duration * duration / length - 2.0 * a2;
  TimedSpan span{piece, duration, {u0, a1, a2, 0.0, 0.0, 0.0}};
  span.u[3] = 10.0 * gap - 4.0 * slope + 0.5 * bend;
  span.u[4] = -15.0 * gap + 7.0 * slope - bend;
  span.u[5] = 6.0 * gap - 3.0 * slope + 0.5 * bend;
  return span;
}

TimedSpan TimedSpan::constant_jerk(size_t piece, double length, const RateState& from, double jerk,
                                   double end, double duration) {
  const double scale = duration / length;
  TimedSpan span{piece,
                 duration,
                 {from.s / length, from.rate * scale, 0.5 * from.change * duration * scale,
                  jerk * duration * duration * scale / 6.0, 0.0, 0.0}};
  // Rounding of earlier spans goes into the speed, unless the span is too short to bear it.
  constexpr double kRounding = 1e-10;
  const double exact = (end - from.s) / length - span.u[2] - span.u[3];
  if (std::abs(exact - span.u[1]) <= kRounding * std::abs(span.u[1])) span.u[1] = exact;
  return span;
}

ShareBounds bound_shares(const Course& course, const TimedSpan& span, int cells, double slack) {
  const Stretch& stretch = course.stretches()[span.piece];
  if (!stretch.straight) return curved_shares(course, span, cells);
  const Shares along = straight_shares(span, stretch, slack);
  return {along, along};
}

Shares prove(const Course& course, const std::vector<TimedSpan>& spans, double slack) {
  constexpr int kFirstCells = 4;
  constexpr int kMostCells = 1 << 12;
  std::vector<ShareBounds> bounds;
  bounds.reserve(spans.size());
  double reached = 0.0;
  for (const TimedSpan& span : spans) {
    bounds.push_back(bound_shares(course, span, kFirstCells, slack));
    reached = std::max(reached, bounds.back().reached.stretch());
  }
  Shares worst;
  for (size_t k = 0; k < spans.size(); ++k) {
    const bool straight = course.stretches()[spans[k].piece].straight;
    for (int cells = 2 * kFirstCells;
         !straight && cells <= kMostCells && bounds[k].proven.stretch() > reached * (1.0 + slack);
         cells *= 2) {
      bounds[k] = bound_shares(course, spans[k], cells, slack);
      reached = std::max(reached, bounds[k].reached.stretch());
    }
    worst.include(bounds[k].proven);
  }
  return worst;
}

bool goes_forward(const TimedSpan& span) {
  constexpr double kRounding = 1e-12;
  double low = 0.0, high = 0.0;
  for (double c : span.u) high += c;
  low = span.u[0];
  if (!(span.duration > 0.0) || !std::isfinite(span.duration)) return false;
  if (!(low >= -kRounding) || !(high <= 1.0 + kRounding) || !(high >= low)) return false;
  const auto& c = span.u;
  return stays_above(to_bernstein<5>({c[1], 2 * c[2], 3 * c[3], 4 * c[4], 5 * c[5]}),
                     -kRounding * (high - low + kRounding));
}

void stretch_time(std::vector<TimedSpan>& spans, double factor) {
  for (TimedSpan& span : spans) span.duration *= factor;
}

double total_duration(const std::vector<TimedSpan>& spans) {
  double sum = 0.0;
  for (const TimedSpan& span : spans) sum += span.duration;
  return sum;
}

std::vector<TrajectoryPiece> to_pieces(const JointPath& path, const std::vector<TimedSpan>& spans) {
  std::vector<TrajectoryPiece> pieces;
  pieces.reserve(spans.size());
  for (const TimedSpan& span : spans) {
    const JointPiece& from = path.pieces()[span.piece];
    TrajectoryPiece piece;
    piece.duration = span.duration;
    piece.joints = from.joints();
    piece.move = from.move;
    piece.timing = span.u;
    for (int k = 0; k < 6; ++k) {
      for (int i = 0; i < from.joints(); ++i) {
        piece.path[static_cast<size_t>(k)][static_cast<size_t>(i)] = from.coefficients(k, i);
      }
    }
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace viapoint::path_timing
