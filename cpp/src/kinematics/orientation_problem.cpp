#include "kinematics/orientation_problem.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/closed_form.hpp"

namespace viapoint {
namespace {

/// The turn of a rotation about `axis`.
double angle_of(const Eigen::Vector3d& axis, const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d across = axis.unitOrthogonal();
  return angle_about(axis, across, rotation * across);
}

}  // namespace

std::optional<OrientationProblem> OrientationProblem::plan(std::span<const Screw> joints) {
  if (joints.size() > 3) return std::nullopt;
  OrientationProblem problem;
  for (const Screw& joint : joints) {
    if (joint.type != JointType::kRevolute) return std::nullopt;
    const auto here = static_cast<size_t>(problem.joints_);
    if (here > 0 && joint.axis.cross(problem.joint_[here - 1].axis).norm() < 1e-6) {
      return std::nullopt;
    }
    problem.joint_[here] = joint;
    ++problem.joints_;
  }
  return problem;
}

void OrientationProblem::solve(const Eigen::Matrix3d& rotation, std::span<const double> held,
                               OrientationRoots& found) const {
  const auto add = [&](const OrientationRoot& root) {
    found.roots[static_cast<size_t>(found.count++)] = root;
  };
  OrientationRoot root;
  if (joints_ == 0) return add(root);
  if (joints_ == 1) {
    root.q[0] = angle_of(joint_[0].axis, rotation);
    return add(root);
  }
  if (joints_ == 2) {
    // Joint 2 leaves its own axis where it is.
    root.q[0] = angle_about(joint_[0].axis, joint_[1].axis, rotation * joint_[1].axis);
    root.q[1] = angle_of(joint_[1].axis, joint_[0].rotation(-root.q[0]) * rotation);
    return add(root);
  }
  // Axis 3 goes to d; R1⁻¹ d must be where joint 2 can carry axis 3: of its height along axis 2.
  // This equation keeps its digits however near d comes to axis 1.
  const Eigen::Vector3d d = rotation * joint_[2].axis;
  Screw turn = joint_[0];
  turn.origin.setZero();
  const JointTerm height = JointTerm::height(Track::back(turn, d), joint_[1].axis);
  const double sine = turn.axis.cross(d).norm();
  const bool aligned = sine < kWristSine;
  Roots roots;
  if (aligned) {
    roots.count = 1;
    roots.q[0] = held[0];
  } else {
    // As far as the slack reaches, the end of the range answers; the orientation is checked anyway.
    roots = height.solve(joint_[1].axis.dot(joint_[2].axis), kBoundary, 0.0);
  }
  for (int i = 0; i < roots.count; ++i) {
    const auto k = static_cast<size_t>(i);
    root.q[0] = roots.q[k];
    const Eigen::Matrix3d rest = joint_[0].rotation(-root.q[0]) * rotation;
    root.q[1] = angle_about(joint_[1].axis, joint_[2].axis, rest * joint_[2].axis);
    root.q[2] = angle_of(joint_[2].axis, joint_[1].rotation(-root.q[1]) * rest);
    root.free = aligned;
    root.sign = d.dot(turn.axis) > 0.0 ? 1.0 : -1.0;
    root.side = aligned ? 0.0 : std::asin(std::min(1.0, sine)) * (i == 0 ? 1.0 : -1.0);
    add(root);
  }
}

}  // namespace viapoint
