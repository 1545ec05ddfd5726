#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "kinematics/closed_form.hpp"
#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint {
namespace {

/// The rows of the task that the arm can move at all, found at a few joint vectors in general
/// position; the position rows alone where even those rows are more than the joints.
std::vector<int> task_rows(const ForwardKinematics& forward) {
  std::array<bool, 6> moves{};
  for (int sample = 1; sample <= 8; ++sample) {
    JointVector q(forward.joints());
    for (int i = 0; i < q.size(); ++i) q[i] = std::sin(1.7 * sample + 2.3 * i);
    const Jacobian jacobian = forward.jacobian(forward.frames(q));
    for (int row = 0; row < 6; ++row) {
      if (jacobian.row(row).cwiseAbs().maxCoeff() > 1e-9) moves[static_cast<size_t>(row)] = true;
    }
  }
  std::vector<int> rows;
  for (int row = 0; row < 6; ++row) {
    if (moves[static_cast<size_t>(row)]) rows.push_back(row);
  }
  if (static_cast<int>(rows.size()) > forward.joints()) {
    std::erase_if(rows, [](int row) { return row >= 3; });
  }
  return rows;
}

using TaskJacobian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxJoints, kMaxJoints>;

/// Those rows of the Jacobian, position rows divided by `length` [m].
TaskJacobian task_jacobian(const ForwardKinematics& forward, const JointVector& q, double length) {
  const Jacobian jacobian = forward.jacobian(forward.frames(q));
  const std::vector<int> rows = task_rows(forward);
  TaskJacobian task(static_cast<Eigen::Index>(rows.size()), forward.joints());
  for (size_t k = 0; k < rows.size(); ++k) {
    task.row(static_cast<Eigen::Index>(k)) = jacobian.row(rows[k]) / (rows[k] < 3 ? length : 1.0);
  }
  return task;
}

}  // namespace

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
  if (const auto arm = recognise_closed_form(forward_)) {
    const ArmSides near = arm->sides(q);
    const auto size_of = [](const std::optional<double>& distance, double unit) {
      return distance ? std::abs(*distance) / unit : std::numeric_limits<double>::infinity();
    };
    const std::array distances{size_of(near.shoulder, near.length), size_of(near.elbow, 1.0),
                               size_of(near.wrist, 1.0)};
    const auto least = std::min_element(distances.begin(), distances.end());
    const std::array names{"shoulder", "elbow", "wrist"};
    const auto index = static_cast<size_t>(least - distances.begin());
    found.name = *least < kNearSingular ? names[index] : "none";
    found.distance = index == 0 ? *least * near.length : *least;
    return found;
  }
  JointVector travel = JointVector::Zero(joints());
  for (int i = 0; i < joints(); ++i) {
    if (forward_.type(i) == JointType::kPrismatic) travel[i] = 1.0;
  }
  const double length = std::max(forward_.reach_bound(travel).maxCoeff(), 1e-3);
  found.distance = Eigen::JacobiSVD<TaskJacobian>(task_jacobian(forward_, q, length))
                       .singularValues()
                       .minCoeff();
  found.name = found.distance < kNearSingularValue ? "boundary" : "none";
  return found;
}

}  // namespace viapoint
