/// @file
/// Factors to SI: `30 * kDegree` is in radians, `20 * kMillimetre` in metres.
#pragma once

#include <numbers>

namespace viapoint {
inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = std::numbers::pi / 180.0;
inline constexpr double kMillimetre = 1e-3;
}  // namespace viapoint
