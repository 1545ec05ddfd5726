/// @file
/// An orientation that is led along a curve.
#pragma once

#include "viapoint/path/orientation_curve.hpp"
#include "viapoint/path/position_curve.hpp"

namespace viapoint {

/// The tool turns as the curve's direction does and no more: no spin about the direction
/// (rotation-minimising frame, Bishop 1975). Knots by the double reflection of Wang, Jüttler, Zheng
/// & Liu (2008), which carries the direction over exactly, with w = t × t' and w' = t × t'' of the
/// unit direction t; twice as many of them until, at seven places between each two, the direction
/// seen by the tool differs by less than `tolerance`.
/// @param from orientation at the start; @param tolerance [rad]
/// @throws MotionError(kDegenerateCurve) where the curve stops or turns on the spot
/// Real-time: not. Threads: any.
[[nodiscard]] OrientationSpline follow_tangent(const PositionCurve& curve,
                                               const Eigen::Matrix3d& from, double tolerance);

}  // namespace viapoint
