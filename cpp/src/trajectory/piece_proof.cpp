#include "trajectory/piece_proof.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viapoint/core/bernstein_bounds.hpp"

namespace viapoint {
namespace {

using Quintic = BernsteinComposition::Path;

/// u may leave [0, 1] by this much through rounding, which moves q by less than kOutside times the
/// sum of its coefficients' magnitudes.
constexpr double kTimingRounding = 1e-14, kOutside = 6.0 * kTimingRounding;
constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon() + kOutside;

std::array<double, 5> derivative(const Quintic& c) {
  return {c[1], 2 * c[2], 3 * c[3], 4 * c[4], 5 * c[5]};
}

double value(const Quintic& c, double x) {
  return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
}

}  // namespace

PieceProof::PieceProof(const TrajectoryPiece& piece) : piece_(piece) {
  const auto [low, high] = std::ranges::minmax(to_bernstein(piece.timing));
  timing_in_range_ = low >= -kTimingRounding && high <= 1.0 + kTimingRounding;
  timing_rises_ = std::ranges::min(to_bernstein(derivative(piece.timing))) >= 0.0;
}

bool PieceProof::within(const Quintic& path, double low, double high) const {
  if (!timing_in_range_) return false;
  // The hull of the whole path piece, with room for rounding.
  double size = 0.0;
  for (const double c : path) size += std::abs(c);
  const auto [least, most] = std::ranges::minmax(to_bernstein(path));
  return least - kRounding * size >= low && most + kRounding * size <= high;
}

PieceProof::Range PieceProof::same_range(const Quintic& path) const {
  const auto [least, most] = std::ranges::minmax(to_bernstein(derivative(path)));
  if (!timing_in_range_ || !timing_rises_ || (least < 0.0 && most > 0.0)) {
    return {composition().of(path, 0), composition().rounding(path, 0)};
  }
  BernsteinPolynomial line(1);
  line.coefficients()[0] = value(path, piece_.timing[0]);
  line.coefficients()[1] = value(path, value(piece_.timing, 1.0));
  // Horner's rule for q, and u's own error times the slope.
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  double size = 0.0, slope = 0.0, timing = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    size += std::abs(path[k]);
    slope += static_cast<double>(k) * std::abs(path[k]);
    timing += std::abs(piece_.timing[k]);
  }
  return {line, kEpsilon * (12.0 * size + 6.0 * slope * timing)};
}

const BernsteinComposition& PieceProof::composition() const {
  if (!composition_) composition_.emplace(piece_);
  return *composition_;
}

}  // namespace viapoint
