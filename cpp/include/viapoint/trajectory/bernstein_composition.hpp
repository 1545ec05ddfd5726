/// @file
/// q(u(x)) as one polynomial in x: the exact shape of a trajectory piece over its time.
#pragma once

#include <array>
#include <cstddef>

#include "viapoint/trajectory/bernstein.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// The powers u(x)^k of a piece's timing and their derivatives by time, in Bernstein form in
/// x = τ/duration. They are the same for all joints, so that a joint costs a few multiply-adds.
///
/// Powers grow by Leibniz' rule and Bernstein products in scaled form (Farouki & Rajan 1988), whose
/// weights are positive: where u stays in [0, 1] nothing is lost to cancellation.
/// Those of an order are brought to a common degree when they are first asked for.
/// Fixed capacity, no heap. Real-time: not meant for it. Threads: one.
class BernsteinComposition {
 public:
  /// Bernstein coefficients times C(n, i), between zeros: products are then plain convolutions.
  /// Degree -1 is zero.
  struct Scaled {
    static constexpr std::size_t kPad = 5;
    int degree = -1;
    std::array<double, kMaxBernsteinDegree + 1 + 2 * kPad> padded{};

    [[nodiscard]] double* data() { return padded.data() + kPad; }
    [[nodiscard]] const double* data() const { return padded.data() + kPad; }
  };
  /// A polynomial and its first three derivatives, each of its own natural degree.
  using Jet = std::array<Scaled, 4>;

  /// Coefficients of a quintic in u, by power.
  using Path = std::array<double, 6>;

  /// @pre piece.joints within [1, kMaxJoints], piece.duration > 0, all coefficients finite
  explicit BernsteinComposition(const TrajectoryPiece& piece);

  /// u(x).
  [[nodiscard]] BernsteinPolynomial timing() const { return of({0.0, 1.0}, 0); }
  /// The derivative of order 0..3 by τ [s] of Σ_k path[k] u(x(τ))^k.
  /// @pre path[k] == 0 where k exceeds the degree of every joint of the piece
  [[nodiscard]] BernsteinPolynomial of(const Path& path, int order) const;
  /// A quick bound of |of(path, order)| on [0, 1], the powers' magnitudes added up: as tight as the
  /// coefficients of of() where the path is straight, looser where powers cancel.
  [[nodiscard]] double magnitude(const Path& path, int order) const;
  /// How far rounding may have moved a coefficient of of(path, order). Grows with the coefficients
  /// of u and path, not with the result: cancellation between them is paid for here.
  [[nodiscard]] double rounding(const Path& path, int order) const;

 private:
  static constexpr int kOrders = 4;
  static constexpr int kPowers = 5;

  /// The power k of u at k - 1, all of one degree.
  using Powers = std::array<BernsteinPolynomial, kPowers>;
  [[nodiscard]] const Powers& raised(std::size_t order) const;

  int timing_degree_ = 0;
  int path_degree_ = 0;
  std::array<Jet, kPowers> jets_;  ///< of the power k at k - 1
  mutable std::array<Powers, kOrders> raised_;
  mutable std::array<bool, kOrders> is_raised_{};
  /// [order][k - 1]
  std::array<std::array<double, kPowers>, kOrders> rounding_{};
  std::array<std::array<double, kPowers>, kOrders> magnitude_{};  ///< largest |coefficient|
};

}  // namespace viapoint
