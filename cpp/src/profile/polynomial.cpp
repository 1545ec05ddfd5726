#include "viapoint/profile/polynomial.hpp"

#include <cassert>
#include <cmath>
#include <ranges>

#include "profile/argument_check.hpp"
#include "profile/polynomial_roots.hpp"

namespace viapoint {
namespace {

/// Share of its terms by which a law may miss its end.
constexpr double kArrivalRounding = 1e-9;

void require_interval(double t0, double t1) {
  require_finite(t0, "t0");
  require_finite(t1, "t1");
  if (t0 < t1) return;
  refuse("the interval ends at " + written(t1) + " s, before it has begun at " + written(t0) +
             " s; it must last longer than 0 s",
         t1 - t0, 0.0);
}

double of_order(const AxisState& state, int derivative) {
  switch (derivative) {
    case 0:
      return state.q;
    case 1:
      return state.qd;
    case 2:
      return state.qdd;
    default:
      return state.qddd;
  }
}

}  // namespace

AxisState Polynomial::at(double t) const {
  const double x = t - t0;
  // Horner's scheme, and its own by which it yields q̇, q̈/2 and q⃛/6 as well.
  double q = 0.0, first = 0.0, second = 0.0, third = 0.0;
  for (const double coefficient : c | std::views::reverse) {
    third = third * x + second;
    second = second * x + first;
    first = first * x + q;
    q = q * x + coefficient;
  }
  return {q, first, 2.0 * second, 6.0 * third};
}

Extremes Polynomial::extremes(int derivative) const {
  assert(derivative >= 0 && derivative <= 3);
  // The next derivative as a polynomial of x = (t − t0)/(t1 − t0), up to a positive factor.
  const double length = t1 - t0;
  Coefficients slope{};
  for (int k = derivative + 1; k <= kMaxDegree; ++k) {
    // Factor by factor, so that no power of a long or a short time stands alone.
    double term = c[static_cast<size_t>(k)];
    for (int m = 0; m <= derivative; ++m) term *= k - m;
    for (int m = derivative; m < k; ++m) term *= length;
    slope[static_cast<size_t>(k - derivative - 1)] = term;
  }
  const auto value = [&](double t) { return of_order(at(t), derivative); };
  Extremes found{value(t0), t0, value(t0), t0};
  const auto look = [&](double t) {
    const double q = value(t);
    if (q < found.low) found.low = q, found.low_time = t;
    if (q > found.high) found.high = q, found.high_time = t;
  };
  const Roots roots = roots_in_unit(slope, kMaxDegree - 1 - derivative);
  for (int i = 0; i < roots.count; ++i) look(t0 + length * roots.x[static_cast<size_t>(i)]);
  look(t1);
  return found;
}

void require_arrival(const Polynomial& law, double end) {
  Polynomial sizes{0.0, law.t1 - law.t0, law.c};
  for (double& c : sizes.c) c = std::abs(c);
  const double reached = law.at(law.t1).q;
  if (std::abs(reached - end) <= kArrivalRounding * sizes.at(sizes.t1).q) return;
  refuse("from " + written(law.t0) + " to " + written(law.t1) + " s the law would end at " +
             written(reached) + " and not at " + written(end) +
             ": its coefficients leave what doubles hold",
         reached, end, {"give shorter or longer times", "give values nearer to one another"});
}

Polynomial cubic(const AxisState& from, const AxisState& to, double t0, double t1) {
  require_finite(std::array{from.q, from.qd, to.q, to.qd}, "boundary value");
  require_interval(t0, t1);
  const double time = t1 - t0;
  const double gap = to.q - from.q;
  Polynomial law{t0, t1, {}};
  law.c[0] = from.q;
  law.c[1] = from.qd;
  law.c[2] = (3.0 * gap / time - 2.0 * from.qd - to.qd) / time;
  law.c[3] = (from.qd + to.qd - 2.0 * gap / time) / (time * time);
  require_arrival(law, to.q);
  return law;
}

Polynomial quintic(const AxisState& from, const AxisState& to, double t0, double t1) {
  require_finite(std::array{from.q, from.qd, from.qdd, to.q, to.qd, to.qdd}, "boundary value");
  require_interval(t0, t1);
  const double time = t1 - t0;
  // What the start state alone would miss at the end, each by unit time.
  const double gap = to.q - from.q - time * (from.qd + 0.5 * time * from.qdd);
  const double slope = time * (to.qd - from.qd - time * from.qdd);
  const double bend = time * time * (to.qdd - from.qdd);
  const double cube = time * time * time;
  Polynomial law{t0, t1, {}};
  law.c[0] = from.q;
  law.c[1] = from.qd;
  law.c[2] = 0.5 * from.qdd;
  law.c[3] = (10.0 * gap - 4.0 * slope + 0.5 * bend) / cube;
  law.c[4] = (-15.0 * gap + 7.0 * slope - bend) / (cube * time);
  law.c[5] = (6.0 * gap - 3.0 * slope + 0.5 * bend) / (cube * time * time);
  require_arrival(law, to.q);
  return law;
}

}  // namespace viapoint
