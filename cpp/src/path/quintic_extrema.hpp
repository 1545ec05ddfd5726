/// @file
/// Where a scalar quintic on [0, 1] exceeds a value, and by how much.
#pragma once

#include <array>
#include <optional>

namespace viapoint {

using Quintic = std::array<double, 6>;  ///< coefficient of u^k

[[nodiscard]] double evaluate(const Quintic& quintic, double u);

/// The first u in [0, 1] where the quintic exceeds zero, to rounding; nothing when it never does.
[[nodiscard]] std::optional<double> first_positive(const Quintic& quintic);

/// The largest value on [0, 1], to `resolution` (never too small).
[[nodiscard]] double maximum(const Quintic& quintic, double resolution);

}  // namespace viapoint
