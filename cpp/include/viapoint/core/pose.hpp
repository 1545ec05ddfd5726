/// @file
/// Rigid poses and rotations. `pose_a_b` maps coordinates of frame b to frame a.
#pragma once

#include <Eigen/Geometry>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint {

/// Position [m] and rotation of a frame seen from another.
using Pose = Eigen::Isometry3d;

/// A pose made sound, and how far the given one was from it.
struct CheckedPose {
  Pose pose;
  double correction = 0.0;  ///< largest element by which the rotation block was changed
};

/// The rotations that two-decimal rounding can hide are projected on the nearest rotation (polar
/// decomposition, Higham 1986); anything farther is refused by its worst pair of columns and their
/// angle, a reflection or a bad bottom row by name.
/// Real-time: not. @throws MotionError(kNotARotation, kBadArgument)
[[nodiscard]] CheckedPose checked_pose(const Eigen::Matrix4d& matrix);

/// The farthest element-wise distance that counts as rounding (two decimals a side).
inline constexpr double kRotationRounding = 0.02;

/// Rotation vector (axis times angle, angle in [0, π]) of R [rad]. At π the axis is one of the two
/// valid ones, chosen deterministically. Real-time: safe.
[[nodiscard]] Eigen::Vector3d rotation_log(const Eigen::Matrix3d& rotation);

/// Rotation of a rotation vector [rad] (Rodrigues 1840). Real-time: safe.
[[nodiscard]] Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& vector);

/// Angle between two rotations [rad], in [0, π]. Real-time: safe.
[[nodiscard]] double rotation_distance(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

}  // namespace viapoint
