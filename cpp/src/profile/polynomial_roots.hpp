/// @file
/// Real roots of a small polynomial inside the unit interval.
#pragma once

#include <cstddef>

#include "viapoint/profile/polynomial.hpp"

namespace viapoint {

/// A few roots, in rising order: no more than there are coefficients.
struct Roots {
  Polynomial::Coefficients x{};
  int count = 0;

  void add(double root) {
    if (count < static_cast<int>(x.size())) x[static_cast<std::size_t>(count++)] = root;
  }
};

/// Roots of Σ c[k] x^k, k <= degree, in [0, 1] where it changes sign, and some where it only
/// touches zero. Between neighbouring roots of the derivative the polynomial is monotone, so each
/// sign change brackets one root, which is closed in on by Newton's steps kept in the bracket.
[[nodiscard]] Roots roots_in_unit(const Polynomial::Coefficients& c, int degree);

}  // namespace viapoint
