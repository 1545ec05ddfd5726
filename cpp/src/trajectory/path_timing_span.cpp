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

bool is_straight(const JointPiece& piece) {
  return (piece.coefficients.bottomRows<4>().array() == 0.0).all();
}

/// Shares of a motion straight along s = length · u, from the extrema of u̇, ü, u⃛.
/// @param per_velocity… one over the limits; zero where there is none
void include_straight(const TimedSpan& span, double length, double per_velocity,
                      double per_acceleration, double per_jerk, ShareBounds& into) {
  const auto& c = span.u;
  const double per_second = 1.0 / span.duration;
  const double rate =
      largest_magnitude<5>({c[1], 2 * c[2], 3 * c[3], 4 * c[4], 5 * c[5]}) * per_second * length;
  const double change = largest_magnitude<4>({2 * c[2], 6 * c[3], 12 * c[4], 20 * c[5]}) *
                        per_second * per_second * length;
  const double jerk = largest_magnitude<3>({6 * c[3], 24 * c[4], 60 * c[5]}) * per_second *
                      per_second * per_second * length;
  const Shares shares{rate * per_velocity, change * per_acceleration, jerk * per_jerk};
  into.reached.include(shares);
  into.proven.include(shares);
}

/// One joint's motion p(u(t)) against its limits, over `cells` parts of the span.
class ScalarBounds {
 public:
  ScalarBounds(const TimedSpan& span, int cells) : cells_(cells), duration_(span.duration) {
    for (int k = 0; k <= cells; ++k) {
      Taylor d = derivatives(span.u, static_cast<double>(k) / cells);
      by_time(d, span.duration);
      at_.push_back(d);
    }
    Taylor mid = derivatives(span.u, 0.5);
    bound_ = derivative_bounds(mid, 0.5);
    by_time(bound_, span.duration);
    const double radius = std::max(std::abs(at_.back()[0] - mid[0]), std::abs(at_[0][0] - mid[0]));
    middle_ = mid[0];
    radius_ = radius;
  }

  /// @param per_velocity… one over the limits; zero where there is none
  void include(const Taylor& path, double per_velocity, double per_acceleration, double per_jerk,
               ShareBounds& into) const {
    const Taylor p_bound = derivative_bounds(derivatives(path, middle_), radius_);
    const Rates curvature = rate_curvatures(p_bound, bound_);
    Rates worst{0.0, 0.0, 0.0};
    for (const Taylor& w : at_) {
      const double u = w[0];
      const double p1 =
          path[1] + u * (2 * path[2] + u * (3 * path[3] + u * (4 * path[4] + u * 5 * path[5])));
      const double p2 = 2 * path[2] + u * (6 * path[3] + u * (12 * path[4] + u * 20 * path[5]));
      const double p3 = 6 * path[3] + u * (24 * path[4] + u * 60 * path[5]);
      const Rates here = rates(p1, p2, p3, w);
      worst.velocity = std::max(worst.velocity, std::abs(here.velocity));
      worst.acceleration = std::max(worst.acceleration, std::abs(here.acceleration));
      worst.jerk = std::max(worst.jerk, std::abs(here.jerk));
    }
    const double step = duration_ / cells_;
    const double chord = step * step / 8.0;
    into.reached.include({worst.velocity * per_velocity, worst.acceleration * per_acceleration,
                          worst.jerk * per_jerk});
    into.proven.include({(worst.velocity + chord * curvature.velocity) * per_velocity,
                         (worst.acceleration + chord * curvature.acceleration) * per_acceleration,
                         (worst.jerk + chord * curvature.jerk) * per_jerk});
  }

 private:
  int cells_;
  double duration_;
  std::vector<Taylor> at_;
  Taylor bound_{};
  double middle_ = 0.0, radius_ = 0.0;
};

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

void Shares::include(const Shares& other) {
  // What is no number is no bound: infinity, which no maximum loses again.
  const auto raise = [](double& mine, double theirs) {
    mine = std::isnan(theirs) ? std::numeric_limits<double>::infinity() : std::max(mine, theirs);
  };
  raise(velocity, other.velocity);
  raise(acceleration, other.acceleration);
  raise(jerk, other.jerk);
}

double Shares::stretch() const {
  return std::max({velocity, std::sqrt(acceleration), std::cbrt(jerk)});
}

ShareBounds bound_shares(const JointPiece& piece, const JointLimits& limits, const TimedSpan& span,
                         int cells) {
  ShareBounds bounds;
  double per_v = 1.0 / piece.rate_limit;
  double per_a = 1.0 / piece.rate_change_limit;
  double per_j = 0.0;
  if (is_straight(piece)) {
    for (int i = 0; i < piece.joints(); ++i) {
      const double rate = std::abs(piece.coefficients(1, i)) / piece.length;
      per_v = std::max(per_v, rate / (limits.velocity[i] * piece.scale));
      per_a = std::max(per_a, rate / (limits.acceleration[i] * piece.scale));
      per_j = std::max(per_j, rate / (limits.jerk[i] * piece.scale));
    }
    include_straight(span, piece.length, per_v, per_a, per_j, bounds);
    return bounds;
  }
  if (per_v > 0.0 || per_a > 0.0) {
    include_straight(span, piece.length, per_v, per_a, per_j, bounds);
  }
  const ScalarBounds scalar(span, cells);
  for (int i = 0; i < piece.joints(); ++i) {
    const auto c = piece.coefficients.col(i);
    scalar.include({c[0], c[1], c[2], c[3], c[4], c[5]}, 1.0 / (limits.velocity[i] * piece.scale),
                   1.0 / (limits.acceleration[i] * piece.scale),
                   1.0 / (limits.jerk[i] * piece.scale), bounds);
  }
  return bounds;
}

Shares prove(const JointPath& path, const JointLimits& limits, const std::vector<TimedSpan>& spans,
             double slack) {
  constexpr int kFirstCells = 4;
  constexpr int kMostCells = 1 << 12;
  std::vector<ShareBounds> bounds;
  bounds.reserve(spans.size());
  double reached = 0.0;
  for (const TimedSpan& span : spans) {
    bounds.push_back(bound_shares(path.pieces()[span.piece], limits, span, kFirstCells));
    reached = std::max(reached, bounds.back().reached.stretch());
  }
  Shares worst;
  for (size_t k = 0; k < spans.size(); ++k) {
    for (int cells = 2 * kFirstCells;
         cells <= kMostCells && bounds[k].proven.stretch() > reached * (1.0 + slack); cells *= 2) {
      bounds[k] = bound_shares(path.pieces()[spans[k].piece], limits, spans[k], cells);
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
