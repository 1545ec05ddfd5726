/// @file
/// The proof that a motion keeps the limits of the tool: bounds over whole intervals, not samples.
#pragma once

#include <array>

#include "viapoint/path/tool_rates.hpp"
#include "viapoint/trajectory/certificate.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// A process speed v counts as held where the tool's is proven to lie in [v (1 - 1e-6), v].
inline constexpr double kHeldWithin = 1e-6;

/// Bounds of the tool's speed over a piece, its rates' error included [m/s].
struct SpeedRange {
  double least = 0.0, most = 0.0;
  double reached = 0.0;  ///< the least of 65 samples
};

/// By 65 samples of ‖w(u)‖² u̇², whose second derivative is bounded from the coefficients of ‖w‖²
/// about the middle: where the speed is about constant, so is the bound, on arcs as on lines.
/// @param timing, duration u(x), as of a TrajectoryPiece
/// @param asked a speed at which `most` matters: up to eight halvings between samples, where it is
///        not known to lie below
[[nodiscard]] SpeedRange tool_speed_range(const std::array<double, 6>& timing, double duration,
                                          const ToolRate& rate, double asked);

/// Gathers the worst shares of the tool's limits, piece by piece. Branch and bound over time: an
/// interval is bounded by its ends and the error of linear interpolation between them, Δt²/8 times
/// a bound of the second derivative by the chain rule, and halved until it holds no more
/// than is known already, or until the bound is within 1e-7 of the limit of what is reached (1e-4
/// where it lies below the limit). The error of the tool rates counts as reached.
/// Real-time: not. Threads: one.
class ToolCertifier {
 public:
  /// @param rates of the path that the piece lies on; @param time where the piece begins [s]
  void add(const TrajectoryPiece& piece, const ToolRates& rates, double time);
  [[nodiscard]] const ToolExtrema& extrema() const { return extrema_; }

 private:
  ToolExtrema extrema_;
  double reached_[4] = {0.0, 0.0, 0.0, 0.0};  ///< shares
};

}  // namespace viapoint
