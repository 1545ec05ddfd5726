/// @file
/// Polynomials on [0, 1] by their Bernstein coefficients b_i: f(x) = Σ b_i C(n,i) x^i (1-x)^(n-i).
/// The curve lies in the hull of its coefficients, the first and last of which are reached, and
/// halving the interval shrinks the gap between the two fourfold (Lane & Riesenfeld 1981). That
/// makes a bound out of a maximum.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace viapoint {

/// A quintic in x in a quintic in u: the highest degree a trajectory piece can have.
inline constexpr int kMaxBernsteinDegree = 25;

/// One polynomial on [0, 1]. Fixed capacity, no heap. Real-time: safe. Threads: any.
class BernsteinPolynomial {
 public:
  /// Zero, of the given degree. @pre 0 <= degree <= kMaxBernsteinDegree
  explicit BernsteinPolynomial(int degree = 0) : size_(static_cast<std::size_t>(degree) + 1) {
    coefficients_.fill(0.0);
  }

  [[nodiscard]] int degree() const { return static_cast<int>(size_) - 1; }
  [[nodiscard]] std::span<double> coefficients() { return {coefficients_.data(), size_}; }
  [[nodiscard]] std::span<const double> coefficients() const {
    return {coefficients_.data(), size_};
  }
  [[nodiscard]] double first() const { return coefficients_[0]; }
  [[nodiscard]] double last() const { return coefficients_[size_ - 1]; }
  /// The largest coefficient: f(x) <= hull() on [0, 1].
  [[nodiscard]] double hull() const;
  [[nodiscard]] BernsteinPolynomial operator-() const;
  /// f(x) by de Casteljau, O(degree²). Meant for tests and single values.
  [[nodiscard]] double operator()(double x) const;
  /// Keeps [0, 1/2] here, scaled to [0, 1], and returns [1/2, 1] likewise (de Casteljau).
  [[nodiscard]] BernsteinPolynomial split_off_upper_half();

 private:
  std::array<double, kMaxBernsteinDegree + 1> coefficients_;
  std::size_t size_;
};

/// The largest value of a set of polynomials.
struct Peak {
  double reached = -std::numeric_limits<double>::infinity();  ///< at some x of one of them
  double bound = -std::numeric_limits<double>::infinity();    ///< none of them exceeds this
};

/// Takes f into `peak`: afterwards peak.bound covers f on the whole of [0, 1], and lies at most
/// `tolerance` + `rounding` above what is reached. Branch and bound: a part of f whose hull is
/// below what has been reached already costs one pass over its coefficients.
/// @param tolerance gap allowed between reached and bound, > 0
/// @param rounding  what the coefficients of f may be wrong by; added to the bound, as is that of
///                  the halvings (1.4e-13 of the largest coefficient)
/// @returns where f reaches a new highest value; nothing if it does not
std::optional<double> raise(Peak& peak, const BernsteinPolynomial& f, double tolerance,
                            double rounding = 0.0);

}  // namespace viapoint
