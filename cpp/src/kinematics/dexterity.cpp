#include "viapoint/kinematics/dexterity.hpp"

#include <Eigen/SVD>
#include <limits>

#include "kinematics/task_jacobian.hpp"

namespace viapoint {
namespace {

/// Of three rows of the Jacobian: an arm of fewer joints has no motion along the last axes.
VelocityEllipsoid ellipsoid_of(const TaskJacobian& rows) {
  const Eigen::JacobiSVD<TaskJacobian> svd(rows, Eigen::ComputeFullU);
  VelocityEllipsoid out;
  out.axes = svd.matrixU();
  out.lengths.head(svd.singularValues().size()) = svd.singularValues();
  return out;
}

/// Least over greatest; 0 when nothing moves.
double ratio_of(const TaskJacobian& matrix) {
  const TaskJacobian tall = matrix.rows() < matrix.cols() ? matrix.transpose() : matrix;
  const auto values = Eigen::JacobiSVD<TaskJacobian>(tall).singularValues();
  return values[0] > 0.0 ? values[values.size() - 1] / values[0] : 0.0;
}

/// The position rows that the arm can move.
TaskJacobian position_rows(const RobotModel& robot, const Jacobian& jacobian) {
  TaskJacobian out(0, jacobian.cols());
  for (const int row : task_rows(robot.forward())) {
    if (row >= 3) continue;
    out.conservativeResize(out.rows() + 1, Eigen::NoChange);
    out.row(out.rows() - 1) = jacobian.row(row);
  }
  return out;
}

}  // namespace

Dexterity dexterity(const RobotModel& robot, const JointVector& q) {
  const Jacobian jacobian = robot.jacobian(q);
  Dexterity out;
  out.yoshikawa = robot.manipulability(q);
  out.length = size_of(robot.forward());
  const TaskJacobian task = task_jacobian(robot.forward(), q, out.length);
  out.least = Eigen::JacobiSVD<TaskJacobian>(task).singularValues().minCoeff();
  out.isotropy = ratio_of(task);
  out.condition = out.isotropy > 0.0 ? 1.0 / out.isotropy : std::numeric_limits<double>::infinity();
  out.linear = ellipsoid_of(jacobian.topRows<3>());
  out.angular = ellipsoid_of(jacobian.bottomRows<3>());
  const TaskJacobian rows = position_rows(robot, jacobian);
  if (rows.rows() > 0) out.asada = ratio_of(rows * robot.limits().acceleration.asDiagonal());
  return out;
}

}  // namespace viapoint
