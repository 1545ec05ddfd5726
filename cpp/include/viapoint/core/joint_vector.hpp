/// @file
/// Joint-space vectors and matrices of fixed capacity: they live on the stack, so the same types
/// serve the planner and the real-time tick.
#pragma once

#include <Eigen/Core>

namespace viapoint {

/// The most joints an arm may have. Every joint-sized type reserves this much and never allocates.
inline constexpr int kMaxJoints = 16;
/// The most coupled limits (rows of C in lower <= C q <= upper).
inline constexpr int kMaxCouplings = 16;

/// One value a joint [rad or m, and their time derivatives], (n,).
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxJoints, 1>;
/// A square matrix over joints, (n, n).
using JointMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxJoints, kMaxJoints>;
/// Geometric Jacobian: rows 0-2 linear velocity of the tool point, rows 3-5 angular velocity, both
/// in the base frame, (6, n).
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxJoints>;
/// Linear velocity over angular velocity of the tool, in the base frame [m/s, rad/s], (6,).
using Twist = Eigen::Matrix<double, 6, 1>;
/// Coupling matrix C, (m, n).
using CouplingMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                     kMaxCouplings, kMaxJoints>;
/// One value a coupled limit, (m,).
using CouplingVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxCouplings, 1>;

}  // namespace viapoint
