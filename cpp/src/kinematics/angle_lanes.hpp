/// @file
/// The angles of many directions at once: what a closed form needs when it has found the sines and
/// cosines of all its branches.
#pragma once

#include <span>

namespace viapoint {

/// angles[i] = atan2(sines[i], cosines[i]) [rad] to within 1e-15, for directions of any finite
/// length; 0 where both are 0. Real-time: safe.
/// @pre all three have the same size
void angles_of(std::span<const double> sines, std::span<const double> cosines,
               std::span<double> angles) noexcept;

}  // namespace viapoint
