/// @file
/// Bounds of polynomials of low degree on [0, 1] from their Bernstein coefficients: the graph lies
/// in their hull, and the first and last are reached (Lane & Riesenfeld 1981).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace viapoint::path_timing {

/// Bernstein coefficients of Σ_k c_k x^k on [0, 1]: b_i = Σ_k C(i,k) / C(n,k) c_k (Farouki & Rajan
/// 1988).
template <size_t Size>
std::array<double, Size> to_bernstein(const std::array<double, Size>& c) {
  std::array<double, Size> b{};
  for (size_t i = 0; i < Size; ++i) {
    double ratio = 1.0;
    for (size_t k = 0; k <= i; ++k) {
      b[i] += ratio * c[k];
      if (k < i) ratio *= static_cast<double>(i - k) / static_cast<double>(Size - 1 - k);
    }
  }
  return b;
}

/// Cuts at one half (de Casteljau): b keeps the upper half, the lower one is returned.
template <size_t Size>
std::array<double, Size> split_off_lower_half(std::array<double, Size>& b) {
  std::array<double, Size> lower{};
  for (size_t k = 0; k < Size; ++k) {
    lower[k] = b[0];
    for (size_t m = 0; m + k + 1 < Size; ++m) b[m] = 0.5 * (b[m] + b[m + 1]);
  }
  return lower;
}

/// A bound, at most a relative 1e-12 above what is reached, unless `depth` runs out.
/// @param floor values below this are of no interest
template <size_t Size>
double largest_value(std::array<double, Size> b, double floor, int depth = 40) {
  const double hull = *std::max_element(b.begin(), b.end());
  const double reached = std::max({b.front(), b.back(), floor});
  constexpr double kSlack = 1e-12;
  if (hull <= reached + kSlack * std::abs(hull) || depth == 0) return std::max(hull, floor);
  const std::array<double, Size> lower = split_off_lower_half(b);
  const double first = largest_value(lower, reached, depth - 1);
  return largest_value(b, first, depth - 1);
}

/// A bound of |Σ_k c_k x^k| on [0, 1].
template <size_t Size>
double largest_magnitude(const std::array<double, Size>& c) {
  std::array<double, Size> b = to_bernstein(c);
  const double above = largest_value(b, 0.0);
  for (double& value : b) value = -value;
  return largest_value(b, above);
}

}  // namespace viapoint::path_timing
