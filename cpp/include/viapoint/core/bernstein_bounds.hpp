/// @file
/// Bounds of polynomials of fixed, low degree on [0, 1] from their Bernstein coefficients: the
/// graph lies in their hull, and the first and last are reached (Lane & Riesenfeld 1981).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace viapoint {

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

/// A bound, at most `slack` above what is reached or `floor`, unless `depth` runs out.
/// @param floor values below this are of no interest
template <size_t Size>
double largest_value(std::array<double, Size> b, double floor, double slack, int depth = 24) {
  const double hull = *std::max_element(b.begin(), b.end());
  const double reached = std::max({b.front(), b.back(), floor});
  if (!(hull > reached + slack) || depth == 0) return std::max(hull, floor);
  const std::array<double, Size> lower = split_off_lower_half(b);
  const double first = largest_value(lower, reached, slack, depth - 1);
  return largest_value(b, first, slack, depth - 1);
}

/// A bound of |Σ_k c_k x^k| on [0, 1], a relative 1e-12 of the largest coefficient wide.
template <size_t Size>
double largest_magnitude(const std::array<double, Size>& c) {
  constexpr double kSlack = 1e-12;
  std::array<double, Size> b = to_bernstein(c);
  double scale = 0.0;
  for (double value : b) scale = std::max(scale, std::abs(value));
  const double above = largest_value(b, 0.0, kSlack * scale);
  for (double& value : b) value = -value;
  return largest_value(b, above, kSlack * scale);
}

/// True if Σ_k b_k is proven to stay at or above `floor` on [0, 1]; b are Bernstein coefficients.
template <size_t Size>
bool stays_above(std::array<double, Size> b, double floor, int depth = 12) {
  if (*std::min_element(b.begin(), b.end()) >= floor) return true;
  if (!(b.front() >= floor) || !(b.back() >= floor) || depth == 0) return false;
  const std::array<double, Size> lower = split_off_lower_half(b);
  return stays_above(lower, floor, depth - 1) && stays_above(b, floor, depth - 1);
}

}  // namespace viapoint
