#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "kinematics/limited_inverse.hpp"
#include "kinematics/task_jacobian.hpp"
#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint {
double RobotModel::manipulability(const JointVector& q) const {
  require_kinematics(q);
  TaskJacobian task = task_jacobian(forward_, q, 1.0);
  if (task.rows() < task.cols()) task.transposeInPlace();
  // With the thin Q R of the longer side, √det(J Jᵀ) = |∏ r_ii|: no digits lost to the square.
  const Eigen::HouseholderQR<TaskJacobian> qr(task);
  return std::abs(qr.matrixQR().diagonal().prod());
}

Singularity RobotModel::singularity(const JointVector& q) const {
  Singularity found;
  found.manipulability = manipulability(q);
  const auto& inverse =
      static_cast<const LimitedInverse&>(*inverse_);  // the factory makes no other
  const std::optional<ArmSides> sides = inverse.singular_sides(q);
  if (sides && (sides->shoulder || sides->elbow || sides->wrist)) {
    const ArmSides& near = *sides;
    const auto nearness = [](const std::optional<double>& distance, double unit) {
      return distance ? std::abs(*distance) / unit : std::numeric_limits<double>::infinity();
    };
    const std::array distances{nearness(near.shoulder, near.length), nearness(near.elbow, 1.0),
                               nearness(near.wrist, 1.0)};
    const auto least = std::min_element(distances.begin(), distances.end());
    const std::array names{"shoulder", "elbow", "wrist"};
    const auto index = static_cast<size_t>(least - distances.begin());
    found.name = *least < kNearSingular ? names[index] : "none";
    found.distance = index == 0 ? *least * near.length : *least;
    return found;
  }
  const double length = size_of(forward_);
  found.distance = Eigen::JacobiSVD<TaskJacobian>(task_jacobian(forward_, q, length))
                       .singularValues()
                       .minCoeff();
  found.name = found.distance < kNearSingularValue ? "boundary" : "none";
  return found;
}

}  // namespace viapoint
