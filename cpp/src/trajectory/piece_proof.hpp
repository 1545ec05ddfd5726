/// @file
/// What is known of a trajectory piece, no dearer than what is asked: quick bounds first, its
/// composed polynomials where these do not tell. The timing has bounds of its own (rate_bounds.hpp)
/// and none of these.
#pragma once

#include <array>
#include <optional>

#include "viapoint/trajectory/bernstein_composition.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// The piece must outlive it and be sound (find_fault). Threads: one.
class PieceProof {
 public:
  /// Coefficients of a quintic in u, by power.
  using Quintic = BernsteinComposition::Path;

  explicit PieceProof(const TrajectoryPiece& piece);

  /// True if u is seen at once to stay in [0, 1]; false tells nothing.
  [[nodiscard]] bool timing_in_range() const { return timing_in_range_; }
  /// True if Σ path[k] u(x)^k is seen at once to stay in [low, high]; false tells nothing.
  [[nodiscard]] bool within(const Quintic& path, double low, double high) const;
  /// A polynomial, and how far rounding may have moved its coefficients.
  struct Range {
    BernsteinPolynomial f;
    double rounding = 0.0;
  };
  /// Σ path[k] u(x)^k as a line between its ends, if it is seen at once that it only rises or only
  /// falls: its range is the same then. Otherwise the polynomial itself.
  [[nodiscard]] Range same_range(const Quintic& path) const;
  [[nodiscard]] const BernsteinComposition& composition() const;

 private:
  const TrajectoryPiece& piece_;
  bool timing_in_range_, timing_rises_;
  mutable std::optional<BernsteinComposition> composition_;
};

}  // namespace viapoint
