/// @file
/// What a robot's numbers may be: beyond these, products of a few leave the range in which doubles
/// are exact.
#pragma once

namespace viapoint {

/// Velocity, acceleration and jerk limits of a joint [rad or m, per s, s² or s³].
inline constexpr double kLeastRate = 1e-9;
inline constexpr double kMostRate = 1e12;

/// The lengths of an arm, to each side [m].
inline constexpr double kLongest = 1e6;

}  // namespace viapoint
