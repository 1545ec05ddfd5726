#include "kinematics/task_jacobian.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace viapoint {

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

TaskJacobian task_jacobian(const ForwardKinematics& forward, const JointVector& q, double length) {
  const Jacobian jacobian = forward.jacobian(forward.frames(q));
  const std::vector<int> rows = task_rows(forward);
  TaskJacobian task(static_cast<Eigen::Index>(rows.size()), forward.joints());
  for (size_t k = 0; k < rows.size(); ++k) {
    task.row(static_cast<Eigen::Index>(k)) = jacobian.row(rows[k]) / (rows[k] < 3 ? length : 1.0);
  }
  return task;
}

double size_of(const ForwardKinematics& forward) {
  JointVector travel = JointVector::Zero(forward.joints());
  for (int i = 0; i < forward.joints(); ++i) {
    if (forward.type(i) == JointType::kPrismatic) travel[i] = 1.0;
  }
  return std::max(forward.reach_bound(travel).maxCoeff(), 1e-3);
}

}  // namespace viapoint
