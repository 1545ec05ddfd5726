#include "trajectory/path_timing_span.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viapoint/core/bernstein_bounds.hpp"

namespace viapoint::path_timing {
namespace {

constexpr int kOrder = 6;                   // coefficients of a quintic
using Taylor = std::array<double, kOrder>;  // derivatives 0..5, not divided by k!

/// Derivatives 0..5 of a quintic with coefficients c at x.
Taylor derivatives(const Taylor& c, double x) {
  return {c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5])))),
          c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5]))),
          2 * c[2] + x * (6 * c[3] + x * (12 * c[4] + x * 20 * c[5])),
          6 * c[3] + x * (24 * c[4] + x * 60 * c[5]),
          24 * c[4] + x * 120 * c[5],
          120 * c[5]};
}

/// Bounds of |derivatives 1..5| within `radius` of where `d` was taken.
Taylor derivative_bounds(const Taylor& d, double radius) {
  Taylor bound{};
  const Taylor m{std::abs(d[0]), std::abs(d[1]), std::abs(d[2]),
                 std::abs(d[3]), std::abs(d[4]), std::abs(d[5])};
  const double r = radius;
  bound[5] = m[5];
  bound[4] = m[4] + r * m[5];
  bound[3] = m[3] + r * (m[4] + r / 2 * m[5]);
  bound[2] = m[2] + r * (m[3] + r / 2 * (m[4] + r / 3 * m[5]));
  bound[1] = m[1] + r * (m[2] + r / 2 * (m[3] + r / 3 * (m[4] + r / 4 * m[5])));
  return bound;
}

/// Derivatives of u by time, from those by x.
void by_time(Taylor& d, double duration) {
  double power = 1.0;
  for (size_t k = 1; k < kOrder; ++k) {
    power /= duration;
    d[k] *= power;
  }
}

/// q̇, q̈, q⃛ by the chain rule; p are derivatives by u, w those of u by time.
struct Rates {
  double velocity, acceleration, jerk;
};

Rates rates(double p1, double p2, double p3, const Taylor& w) {
  return {p1 * w[1], p2 * w[1] * w[1] + p1 * w[2],
          (p3 * w[1] * w[1] + 3 * p2 * w[2]) * w[1] + p1 * w[3]};
}

/// Second time derivatives of q̇, q̈, q⃛ for magnitudes p, w (Faà di Bruno, all terms added).
Rates rate_curvatures(const Taylor& p, const Taylor& w) {
  const double w11 = w[1] * w[1];
  const double third = p[3] * w11 * w[1] + 3 * p[2] * w[1] * w[2] + p[1] * w[3];
  const double fourth = p[4] * w11 * w11 + 6 * p[3] * w11 * w[2] +
                        p[2] * (4 * w[1] * w[3] + 3 * w[2] * w[2]) + p[1] * w[4];
  const double fifth = p[5] * w11 * w11 * w[1] + 10 * p[4] * w11 * w[1] * w[2] +
                       p[3] * (10 * w11 * w[3] + 15 * w[1] * w[2] * w[2]) +
                       p[2] * (5 * w[1] * w[4] + 10 * w[2] * w[3]) + p[1] * w[5];
  return {third, fourth, fifth};
}

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
  Shares shares;
  if (std::isfinite(stretch.rate_limit)) {
    shares.velocity = magnitude<5>({c[1], 2 * c[2], 3 * c[3], 4 * c[4], 5 * c[5]}, slack) * first /
                      stretch.rate_limit;
  }
  if (std::isfinite(stretch.change_limit)) {
    shares.acceleration = magnitude<4>({2 * c[2], 6 * c[3], 12 * c[4], 20 * c[5]}, slack) * second /
                          stretch.change_limit;
  }
  if (stretch.straight && std::isfinite(stretch.jerk_limit)) {
    shares.jerk = magnitude<3>({6 * c[3], 24 * c[4], 60 * c[5]}, slack) * second * per_second /
                  stretch.jerk_limit;
  }
  return shares;
}

/// All joints' motion q(u(t)) against their limits, over `cells` parts of the span.
ShareBounds curved_shares(const Course& course, const TimedSpan& span, int cells) {
  const JointPiece& piece = *course.stretches()[span.piece].geometry;
  const auto& q = piece.coefficients;
  const auto joints = static_cast<int>(q.cols());
  std::array<Rates, kMaxJoints> worst{};
  for (int k = 0; k <= cells; ++k) {
    Taylor w = derivatives(span.u, static_cast<double>(k) / cells);
    by_time(w, span.duration);
    const double u = w[0];
    for (int i = 0; i < joints; ++i) {
      const double c2 = q(2, i), c3 = q(3, i), c4 = q(4, i), c5 = q(5, i);
      const Rates here = rates(q(1, i) + u * (2 * c2 + u * (3 * c3 + u * (4 * c4 + u * 5 * c5))),
                               2 * c2 + u * (6 * c3 + u * (12 * c4 + u * 20 * c5)),
                               6 * c3 + u * (24 * c4 + u * 60 * c5), w);
      Rates& most = worst[static_cast<size_t>(i)];
      most.velocity = std::max(most.velocity, std::abs(here.velocity));
      most.acceleration = std::max(most.acceleration, std::abs(here.acceleration));
      most.jerk = std::max(most.jerk, std::abs(here.jerk));
    }
  }
  const Taylor middle = derivatives(span.u, 0.5);
  Taylor bound = derivative_bounds(middle, 0.5);
  by_time(bound, span.duration);
  double end = 0.0;
  for (double c : span.u) end += c;
  const double radius = std::max(std::abs(end - middle[0]), std::abs(span.u[0] - middle[0]));
  const double step = span.duration / cells, chord = step * step / 8.0;
  ShareBounds bounds;
  for (int i = 0; i < joints; ++i) {
    const Taylor path{q(0, i), q(1, i), q(2, i), q(3, i), q(4, i), q(5, i)};
    const Rates curvature =
        rate_curvatures(derivative_bounds(derivatives(path, middle[0]), radius), bound);
    const Rates& most = worst[static_cast<size_t>(i)];
    const Shares per = course.shares_per_rate(span.piece, i);
    bounds.reached.include(
        {most.velocity * per.velocity, most.acceleration * per.acceleration, most.jerk * per.jerk});
    bounds.proven.include({(most.velocity + chord * curvature.velocity) * per.velocity,
                           (most.acceleration + chord * curvature.acceleration) * per.acceleration,
                           (most.jerk + chord * curvature.jerk) * per.jerk});
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
  const Shares along = straight_shares(span, stretch, slack);
  if (stretch.straight) return {along, along};
  ShareBounds bounds = curved_shares(course, span, cells);
  bounds.reached.include(along);
  bounds.proven.include(along);
  return bounds;
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
    for (int k = 0; k < kOrder; ++k) {
      for (int i = 0; i < from.joints(); ++i) {
        piece.path[static_cast<size_t>(k)][static_cast<size_t>(i)] = from.coefficients(k, i);
      }
    }
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace viapoint::path_timing
