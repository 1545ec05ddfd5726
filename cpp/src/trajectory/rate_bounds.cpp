#include "trajectory/rate_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viapoint {
namespace {

/// Derivatives 0..5 of a quintic with coefficients c at x.
Quintic derivatives(const Quintic& c, double x) {
  return {c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5])))),
          c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5]))),
          2 * c[2] + x * (6 * c[3] + x * (12 * c[4] + x * 20 * c[5])),
          6 * c[3] + x * (24 * c[4] + x * 60 * c[5]),
          24 * c[4] + x * 120 * c[5],
          120 * c[5]};
}

/// Bounds of |derivatives 1..5| within `radius` of where `d` was taken.
Quintic derivative_bounds(const Quintic& d, double radius) {
  Quintic bound{};
  const double r = radius;
  bound[5] = std::abs(d[5]);
  bound[4] = std::abs(d[4]) + r * bound[5];
  bound[3] = std::abs(d[3]) + r * (std::abs(d[4]) + r / 2 * bound[5]);
  bound[2] = std::abs(d[2]) + r * (std::abs(d[3]) + r / 2 * (std::abs(d[4]) + r / 3 * bound[5]));
  bound[1] =
      std::abs(d[1]) +
      r * (std::abs(d[2]) + r / 2 * (std::abs(d[3]) + r / 3 * (std::abs(d[4]) + r / 4 * bound[5])));
  return bound;
}

/// Derivatives of u by time, from those by x.
void by_time(Quintic& d, double duration) {
  double power = 1.0;
  for (std::size_t k = 1; k < d.size(); ++k) {
    power /= duration;
    d[k] *= power;
  }
}

}  // namespace

TimingSamples::TimingSamples(const Quintic& timing, double duration, int parts, double from,
                             double to)
    : parts_(parts) {
  for (int k = 0; k <= parts; ++k) {
    Quintic& d = at_[static_cast<std::size_t>(k)];
    d = derivatives(timing, from + (to - from) * k / parts);
    by_time(d, duration);
  }
  const Quintic middle = derivatives(timing, 0.5 * (from + to));
  bound_ = derivative_bounds(middle, 0.5 * (to - from));
  middle_ = middle[0];
  // Between its ends u may bulge, but not farther than its slope allows.
  radius_ = 0.5 * (to - from) * bound_[1];
  by_time(bound_, duration);
  const double step = (to - from) * duration / parts;
  chord_ = step * step / 8.0;
}

double TimingSamples::least(std::size_t order) const {
  double least = std::abs(at_[0][order]);
  for (std::size_t k = 1; k <= static_cast<std::size_t>(parts_); ++k) {
    least = std::min(least, std::abs(at_[k][order]));
  }
  return least;
}

Rates TimingSamples::reached(const Quintic& c) const {
  Rates most;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(parts_); ++k) {
    const Quintic& w = at_[k];
    const double u = w[0];
    const double p1 = c[1] + u * (2 * c[2] + u * (3 * c[3] + u * (4 * c[4] + u * 5 * c[5])));
    const double p2 = 2 * c[2] + u * (6 * c[3] + u * (12 * c[4] + u * 20 * c[5]));
    const double p3 = 6 * c[3] + u * (24 * c[4] + u * 60 * c[5]);
    most.velocity = std::max(most.velocity, std::abs(p1 * w[1]));
    most.acceleration = std::max(most.acceleration, std::abs(p2 * w[1] * w[1] + p1 * w[2]));
    most.jerk =
        std::max(most.jerk, std::abs((p3 * w[1] * w[1] + 3 * p2 * w[2]) * w[1] + p1 * w[3]));
  }
  return most;
}

Rates TimingSamples::between(const Quintic& path) const {
  const Quintic p = derivative_bounds(derivatives(path, middle_), radius_);
  const Quintic& w = bound_;
  // Second time derivatives of the rates (Faà di Bruno, all terms added).
  const double w11 = w[1] * w[1];
  const double third = p[3] * w11 * w[1] + 3 * p[2] * w[1] * w[2] + p[1] * w[3];
  const double fourth = p[4] * w11 * w11 + 6 * p[3] * w11 * w[2] +
                        p[2] * (4 * w[1] * w[3] + 3 * w[2] * w[2]) + p[1] * w[4];
  const double fifth = p[5] * w11 * w11 * w[1] + 10 * p[4] * w11 * w[1] * w[2] +
                       p[3] * (10 * w11 * w[3] + 15 * w[1] * w[2] * w[2]) +
                       p[2] * (5 * w[1] * w[4] + 10 * w[2] * w[3]) + p[1] * w[5];
  // What rounding may have taken off the samples, from the terms they are sums of.
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  const double velocity = p[1] * w[1], acceleration = p[2] * w11 + p[1] * w[2];
  const double jerk = p[3] * w11 * w[1] + 3 * p[2] * w[1] * w[2] + p[1] * w[3];
  return {chord_ * third + kRounding * velocity, chord_ * fourth + kRounding * acceleration,
          chord_ * fifth + kRounding * jerk};
}

Rates TimingSamples::reached(const VectorQuintic& w) const {
  double velocity = 0.0, acceleration = 0.0;  // squared
  for (std::size_t k = 0; k <= static_cast<std::size_t>(parts_); ++k) {
    const double u = at_[k][0], first = at_[k][1], second = at_[k][2];
    double speed = 0.0, change = 0.0;
    for (const Quintic& c : w) {
      const double value = c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5]))));
      const double slope = c[1] + u * (2 * c[2] + u * (3 * c[3] + u * (4 * c[4] + u * 5 * c[5])));
      const double a = slope * first * first + value * second;
      speed += value * value;
      change += a * a;
    }
    velocity = std::max(velocity, speed * first * first);
    acceleration = std::max(acceleration, change);
  }
  return {std::sqrt(velocity), std::sqrt(acceleration), 0.0};
}

Rates TimingSamples::between(const VectorQuintic& w) const {
  std::array<double, 4> p{};  // lengths of the derivatives 0..3 of w by u
  for (const Quintic& axis : w) {
    const Quintic middle = derivatives(axis, middle_);
    Quintic bound = derivative_bounds(middle, radius_);
    bound[0] = std::abs(middle[0]) + radius_ * bound[1];
    for (std::size_t k = 0; k < p.size(); ++k) p[k] += bound[k] * bound[k];
  }
  for (double& value : p) value = std::sqrt(value);
  const Quintic& t = bound_;
  const double t11 = t[1] * t[1];
  const double third = p[2] * t11 * t[1] + 3 * p[1] * t[1] * t[2] + p[0] * t[3];
  const double fourth = p[3] * t11 * t11 + 6 * p[2] * t11 * t[2] +
                        p[1] * (4 * t[1] * t[3] + 3 * t[2] * t[2]) + p[0] * t[4];
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  return {chord_ * third + kRounding * p[0] * t[1],
          chord_ * fourth + kRounding * (p[1] * t11 + p[0] * t[2]), 0.0};
}

}  // namespace viapoint
