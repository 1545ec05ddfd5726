/// @file
#pragma once

#include <vector>

#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

using TaskJacobian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxJoints, kMaxJoints>;

/// The rows of the task that the arm can move at all, found at a few joint vectors in general
/// position; the position rows alone where even those rows are more than the joints.
[[nodiscard]] std::vector<int> task_rows(const ForwardKinematics& forward);
/// Those rows of the Jacobian, position rows divided by `length` [m].
[[nodiscard]] TaskJacobian task_jacobian(const ForwardKinematics& forward, const JointVector& q,
                                         double length);
/// A length of the arm's size, by which metres become comparable with radians [m].
[[nodiscard]] double size_of(const ForwardKinematics& forward);

}  // namespace viapoint
