#include "viapoint/trajectory/bernstein_composition.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace viapoint {
namespace {

constexpr int kCapacity = kMaxBernsteinDegree + 1;

constexpr auto kBinomials = [] {
  std::array<std::array<double, kCapacity>, kCapacity> table{};
  for (std::size_t n = 0; n < kCapacity; ++n) {
    table[n][0] = 1.0;
    for (std::size_t k = 1; k <= n; ++k) {
      table[n][k] = table[n - 1][k - 1] + (k < n ? table[n - 1][k] : 0.0);
    }
  }
  return table;
}();

double binomial(int n, int k) {
  return kBinomials[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)];
}

/// Their inverses: division is slow.
constexpr auto kInverses = [] {
  auto table = kBinomials;
  for (std::size_t n = 0; n < kCapacity; ++n) {
    for (std::size_t k = 0; k <= n; ++k) table[n][k] = 1.0 / kBinomials[n][k];
  }
  return table;
}();

using Scaled = BernsteinComposition::Scaled;

/// 1, raised to every degree.
constexpr auto kOnes = [] {
  std::array<Scaled, kCapacity> ones;
  for (std::size_t n = 0; n < kCapacity; ++n) {
    ones[n].degree = static_cast<int>(n);
    for (std::size_t k = 0; k <= n; ++k) ones[n].padded[Scaled::kPad + k] = kBinomials[n][k];
  }
  return ones;
}();

double inverse_binomial(int n, int k) {
  return kInverses[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)];
}

/// sum[m] += factor Σ f[i] g[m - i] over the first `count` m, f having Size coefficients; g is
/// padded with zeros.
template <std::size_t Size>
void convolve(const double* f, double factor, const double* g, std::size_t count, double* sum) {
  std::array<double, Size> weight;
  for (std::size_t i = 0; i < Size; ++i) weight[i] = factor * f[i];
  for (std::size_t m = 0; m < count; ++m) {
    double total = 0.0;
    for (std::size_t i = 0; i < Size; ++i) total += weight[i] * *(g + m - i);
    sum[m] += total;
  }
}

/// sum += factor f g. @pre sum.degree == f.degree + g.degree unless one of them is zero
void add_product(Scaled& sum, double factor, const Scaled& f, const Scaled& g) {
  if (f.degree < 0 || g.degree < 0) return;
  if (f.degree > g.degree) return add_product(sum, factor, g, f);
  constexpr std::size_t kMost = Scaled::kPad + 1;
  const auto nf = static_cast<std::size_t>(f.degree) + 1;
  const auto ng = static_cast<std::size_t>(g.degree) + 1;
  for (std::size_t at = 0; at < nf; at += kMost) {
    const std::size_t part = std::min(kMost, nf - at), count = part + ng - 1;
    const double* from = f.data() + at;
    double* to = sum.data() + at;
    switch (part) {
      case 1:
        convolve<1>(from, factor, g.data(), count, to);
        break;
      case 2:
        convolve<2>(from, factor, g.data(), count, to);
        break;
      case 3:
        convolve<3>(from, factor, g.data(), count, to);
        break;
      case 4:
        convolve<4>(from, factor, g.data(), count, to);
        break;
      case 5:
        convolve<5>(from, factor, g.data(), count, to);
        break;
      default:
        convolve<kMost>(from, factor, g.data(), count, to);
    }
  }
}

/// A polynomial and its first three derivatives, each of its own natural degree.
using Jet = BernsteinComposition::Jet;
/// Upper bounds of the same.
using Magnitude = std::array<double, 4>;

/// Leibniz' rule.
void leibniz(const Jet& f, const Jet& g, Jet& result) {
  for (int d = 0; d < 4; ++d) {
    Scaled& sum = result[static_cast<std::size_t>(d)];
    sum.degree = std::max(-1, f[0].degree + g[0].degree - d);
    for (int i = 0; i <= d; ++i) {
      add_product(sum, binomial(d, i), f[static_cast<std::size_t>(i)],
                  g[static_cast<std::size_t>(d - i)]);
    }
  }
}

Magnitude leibniz(const Magnitude& f, const Magnitude& g) {
  return {f[0] * g[0], f[1] * g[0] + f[0] * g[1], f[2] * g[0] + 2 * f[1] * g[1] + f[0] * g[2],
          f[3] * g[0] + 3 * (f[2] * g[1] + f[1] * g[2]) + f[0] * g[3]};
}

int degree_of(const std::array<double, 6>& monomials) {
  for (int k = 5; k > 0; --k) {
    if (monomials[static_cast<std::size_t>(k)] != 0.0) return k;
  }
  return 0;
}

int path_degree_of(const TrajectoryPiece& piece) {
  const auto moves = [](double c) { return c != 0.0; };
  for (int k = 5; k > 0; --k) {
    const auto& row = piece.path[static_cast<std::size_t>(k)];
    if (std::any_of(row.begin(), row.begin() + piece.joints, moves)) return k;
  }
  return 0;
}

/// Monomials a_j of the given degree: Σ a_j x^j (x + 1 - x)^(n-j), written out.
Scaled from_monomials(const std::array<double, 6>& a, int degree) {
  Scaled result;
  result.degree = degree;
  for (int i = 0; i <= degree; ++i) {
    double& sum = result.data()[i];
    for (int j = 0; j <= i; ++j) {
      sum += binomial(degree - j, i - j) * a[static_cast<std::size_t>(j)];
    }
  }
  return result;
}

double magnitude(const Scaled& f) {
  if (f.degree < 0) return 0.0;
  using Row = Eigen::Map<const Eigen::ArrayXd>;
  const auto& inverses = kInverses[static_cast<std::size_t>(f.degree)];
  return (Row(f.data(), f.degree + 1) * Row(inverses.data(), f.degree + 1)).abs().maxCoeff();
}

/// Rounding of u's own coefficients, as a share of the sum of its monomials' magnitudes: six terms
/// of the conversion, each with a product, by half an epsilon.
constexpr double kConversionRounding = 4.0 * std::numeric_limits<double>::epsilon();
/// Rounding of the k-th power, as a share of k times its magnitude: a product (at most 6 terms each
/// under 4 of Leibniz' rule) for every factor, one elevation (21 terms), division, and the sum over
/// the powers, each by half an epsilon.
constexpr double kProductRounding = 32.0 * std::numeric_limits<double>::epsilon();

/// u by time: its polynomials, bounds of them, and bounds of their rounding, that of a product with
/// them included.
struct TimingJet {
  Jet jet;
  Magnitude size;
  Magnitude error;
};

TimingJet timing_jet(const TrajectoryPiece& piece, int degree) {
  TimingJet u;
  std::array<double, 6> a = piece.timing;
  for (int order = 0; order < 4; ++order) {
    const auto d = static_cast<std::size_t>(order);
    u.jet[d] = degree >= order ? from_monomials(a, degree - order) : Scaled{};
    u.size[d] = magnitude(u.jet[d]);
    double monomials = 0.0;
    for (const double c : a) monomials += std::abs(c);
    u.error[d] = kConversionRounding * monomials + kProductRounding * u.size[d];
    for (std::size_t k = 1; k < 6; ++k) a[k - 1] = static_cast<double>(k) * a[k] / piece.duration;
    a[5] = 0.0;
  }
  return u;
}

}  // namespace

BernsteinComposition::BernsteinComposition(const TrajectoryPiece& piece)
    : timing_degree_(degree_of(piece.timing)), path_degree_(path_degree_of(piece)) {
  const TimingJet u = timing_jet(piece, timing_degree_);
  // Even a piece that stands still has a timing, which is asked for.
  path_degree_ = std::max(path_degree_, 1);
  Magnitude size_before = {1.0, 0.0, 0.0, 0.0};
  for (int k = 1; k <= path_degree_; ++k) {
    const auto at = static_cast<std::size_t>(k) - 1;
    if (k == 1) {
      jets_[at] = u.jet;
    } else {
      leibniz(u.jet, jets_[at - 1], jets_[at]);
      size_before = leibniz(u.size, size_before);
    }
    // First order in the error of u: d(u^k) = k u^(k-1) du.
    const Magnitude error = leibniz(u.error, size_before);
    for (std::size_t d = 0; d < kOrders; ++d) {
      rounding_[d][at] = k * error[d];
      magnitude_[d][at] = viapoint::magnitude(jets_[at][d]);
    }
  }
}

const BernsteinComposition::Powers& BernsteinComposition::raised(std::size_t order) const {
  Powers& powers = raised_[order];
  if (is_raised_[order]) return powers;
  is_raised_[order] = true;
  for (int k = 1; k <= path_degree_; ++k) {
    const auto at = static_cast<std::size_t>(k) - 1;
    const Scaled& power = jets_[at][order];
    const int raise = timing_degree_ * (path_degree_ - k), degree = power.degree + raise;
    Scaled sum;
    add_product(sum, 1.0, kOnes[static_cast<std::size_t>(raise)], power);
    powers[at] = BernsteinPolynomial(std::max(degree, 0));
    for (int i = 0; i <= degree && power.degree >= 0; ++i) {
      powers[at].coefficients()[static_cast<std::size_t>(i)] =
          sum.data()[i] * inverse_binomial(degree, i);
    }
  }
  return powers;
}

BernsteinPolynomial BernsteinComposition::of(const Path& path, int order) const {
  const Powers& powers = raised(static_cast<std::size_t>(order));
  BernsteinPolynomial sum(std::max(0, timing_degree_ * path_degree_ - order));
  const auto b = sum.coefficients();
  if (order == 0) std::ranges::fill(b, path[0]);
  for (std::size_t k = 1; k <= static_cast<std::size_t>(path_degree_); ++k) {
    if (path[k] == 0.0) continue;
    const auto power = powers[k - 1].coefficients();
    for (std::size_t i = 0; i < power.size(); ++i) b[i] += path[k] * power[i];
  }
  return sum;
}

double BernsteinComposition::magnitude(const Path& path, int order) const {
  const auto& magnitude = magnitude_[static_cast<std::size_t>(order)];
  double sum = order == 0 ? std::abs(path[0]) : 0.0;
  for (std::size_t k = 1; k <= kPowers; ++k) sum += std::abs(path[k]) * magnitude[k - 1];
  return sum;
}

double BernsteinComposition::rounding(const Path& path, int order) const {
  const auto& rounding = rounding_[static_cast<std::size_t>(order)];
  double sum = 0.0;
  for (std::size_t k = 1; k <= kPowers; ++k) sum += std::abs(path[k]) * rounding[k - 1];
  return sum;
}

}  // namespace viapoint
