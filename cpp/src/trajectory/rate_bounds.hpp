/// @file
/// Bounds of velocity, acceleration and jerk of q(u(τ)) that need no composed polynomial: samples,
/// and what may lie between them.
///
/// Between two instants Δt apart, |f| <= max(|f0|, |f1|) + Δt²/8 · sup|f''|, the error of linear
/// interpolation; sup|f''| comes from the Taylor forms of q(u) and u(τ) about the middle and the
/// chain rule (Faà di Bruno), without sampling.
#pragma once

#include <array>
#include <cstddef>

namespace viapoint {

/// Of a quintic: its coefficients, or its derivatives 0..5, not divided by k!
using Quintic = std::array<double, 6>;

/// A vector by its quintics on three axes.
using VectorQuintic = std::array<Quintic, 3>;

struct Rates {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
};

/// u(τ) of one piece at equally spaced instants. Fixed capacity, no heap.
class TimingSamples {
 public:
  static constexpr int kMostParts = 16;

  /// @param timing coefficients of u by x = τ/duration
  /// @param from, to the samples are of this part of the piece, by x
  /// @pre duration > 0, 1 <= parts <= kMostParts
  TimingSamples(const Quintic& timing, double duration, int parts, double from = 0.0,
                double to = 1.0);

  /// Largest magnitudes of the rates of Σ path[k] u^k at the instants.
  [[nodiscard]] Rates reached(const Quintic& path) const;
  /// What they may be more than that between the instants, and for rounding.
  [[nodiscard]] Rates between(const Quintic& path) const;

  /// The same of the vectors w(u) u̇ and d/dτ (w(u) u̇), by their lengths, as velocity and
  /// acceleration.
  [[nodiscard]] Rates reached(const VectorQuintic& w) const;
  [[nodiscard]] Rates between(const VectorQuintic& w) const;
  /// |u̇| and |ü|: the least at the instants, and bounds.
  [[nodiscard]] double least_rate() const { return least(1); }
  [[nodiscard]] double least_change() const { return least(2); }
  [[nodiscard]] double most_rate() const { return bound_[1]; }
  [[nodiscard]] double most_change() const { return bound_[2]; }

 private:
  [[nodiscard]] double least(std::size_t order) const;

  int parts_;
  std::array<Quintic, kMostParts + 1> at_;  ///< derivatives by τ
  Quintic bound_{};                         ///< of the magnitudes of derivatives 1..5 by τ
  double middle_ = 0.0, radius_ = 0.0;      ///< u lies within `radius` of `middle`
  double chord_ = 0.0;
};

}  // namespace viapoint
