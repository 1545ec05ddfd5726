/// @file
/// q(u(x)) as one polynomial in x: the exact shape of a trajectory piece over its time.
#pragma once

#include <array>

#include "viapoint/trajectory/bernstein.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// The powers u(x)^k of a piece's timing and their derivatives by time, in Bernstein form in
/// x = τ/duration. They are the same for all joints, so that a joint costs a few multiply-adds.
///
/// Powers grow by Leibniz' rule and Bernstein products in scaled form (Farouki & Rajan 1988), whose
/// weights are positive: where u stays in [0, 1] nothing is lost to cancellation.
/// Fixed capacity, no heap. Real-time: not meant for it. Threads: any.
class BernsteinComposition {
 public:
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

  int timing_degree_ = 0;
  int path_degree_ = 0;
  /// [order][k - 1]: the power k of u, at the common degree of its order.
  std::array<std::array<BernsteinPolynomial, kPowers>, kOrders> powers_;
  std::array<std::array<double, kPowers>, kOrders> rounding_{};
  std::array<std::array<double, kPowers>, kOrders> magnitude_{};  ///< largest |coefficient|
};

}  // namespace viapoint
