#include "profile/polynomial_roots.hpp"

#include <cmath>

namespace viapoint {
namespace {

double value(const Polynomial::Coefficients& c, int degree, double x) {
  double sum = c[static_cast<size_t>(degree)];
  for (int k = degree - 1; k >= 0; --k) sum = sum * x + c[static_cast<size_t>(k)];
  return sum;
}

Polynomial::Coefficients derivative(const Polynomial::Coefficients& c, int degree) {
  Polynomial::Coefficients d{};
  for (int k = 1; k <= degree; ++k) {
    d[static_cast<size_t>(k - 1)] = k * c[static_cast<size_t>(k)];
  }
  return d;
}

/// The root between low and high, where the values have opposite signs.
double bracketed_root(const Polynomial::Coefficients& c, const Polynomial::Coefficients& slope,
                      int degree, double low, double high) {
  const bool rising = value(c, degree, low) < 0.0;
  double x = 0.5 * (low + high);
  // Each round halves the bracket at worst, and 64 halvings exhaust a double.
  for (int round = 0; round < 64; ++round) {
    const double f = value(c, degree, x);
    if (f == 0.0) return x;
    ((f < 0.0) == rising ? low : high) = x;
    const double df = value(slope, degree - 1, x);
    double next = x - f / df;
    if (!(next > low && next < high) || round % 3 == 2) next = 0.5 * (low + high);
    if (next == x) return x;
    x = next;
  }
  return x;
}

}  // namespace

Roots roots_in_unit(const Polynomial::Coefficients& c, int degree) {
  Roots roots;
  while (degree > 0 && c[static_cast<size_t>(degree)] == 0.0) --degree;
  if (degree == 0) return roots;
  const Polynomial::Coefficients slope = derivative(c, degree);
  Roots bends = roots_in_unit(slope, degree - 1);
  bends.add(1.0);
  double low = 0.0;
  double low_value = value(c, degree, low);
  for (int i = 0; i < bends.count; ++i) {
    const double high = bends.x[static_cast<size_t>(i)];
    const double high_value = value(c, degree, high);
    if (low_value == 0.0) {
      roots.add(low);
    } else if ((low_value < 0.0) != (high_value < 0.0) && high_value != 0.0) {
      roots.add(bracketed_root(c, slope, degree, low, high));
    }
    low = high;
    low_value = high_value;
  }
  if (low_value == 0.0) roots.add(low);
  return roots;
}

}  // namespace viapoint
