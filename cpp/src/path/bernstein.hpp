/// @file
/// Scalar quintics on [0, 1] in Bernstein form: the control values bound the polynomial, and
/// halving (de Casteljau) tightens them quadratically (Lane & Riesenfeld 1981).
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace viapoint {

using Quintic = std::array<double, 6>;    ///< coefficient of u^k
using Bernstein = std::array<double, 6>;  ///< control values

[[nodiscard]] Bernstein control_values(const Quintic& quintic);
[[nodiscard]] double evaluate(const Quintic& quintic, double u);

/// The first u in [0, 1] where the quintic exceeds zero, to rounding; nothing when it never does.
[[nodiscard]] std::optional<double> first_positive(const Quintic& quintic);

/// The largest value on [0, 1], to `resolution` (never too small).
[[nodiscard]] double maximum(const Quintic& quintic, double resolution);

}  // namespace viapoint
