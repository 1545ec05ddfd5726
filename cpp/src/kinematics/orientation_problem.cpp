#include "kinematics/orientation_problem.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/angle_lanes.hpp"
#include "kinematics/closed_form.hpp"

namespace viapoint {
namespace {

/// The turn of a rotation about `axis`.
double angle_of(const Eigen::Vector3d& axis, const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d across = axis.unitOrthogonal();
  return angle_about(axis, across, rotation * across);
}

/// `v` turned about `axis` by the inverse of an angle of this cosine and sine (Rodrigues 1840).
inline Eigen::Vector3d turn_back(const Eigen::Vector3d& axis, double cosine, double sine,
                                 const Eigen::Vector3d& v) {
  return cosine * v - sine * axis.cross(v) + ((1.0 - cosine) * axis.dot(v)) * axis;
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
  if (problem.joints_ == 3) {
    const Eigen::Vector3d& second = problem.joint_[1].axis;
    const Eigen::Vector3d& third = problem.joint_[2].axis;
    problem.between_ = second.dot(third);
    problem.tilt_ = third - problem.between_ * second;
    problem.tilt_on_ = second.cross(third);
    problem.mark_ = third.unitOrthogonal();
    problem.mark_on_ = third.cross(problem.mark_);
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
  solve_three(rotation, held, found);
}

void OrientationProblem::solve_three(const Eigen::Matrix3d& rotation, std::span<const double> held,
                                     OrientationRoots& found) const {
  const Eigen::Vector3d& first = joint_[0].axis;
  const Eigen::Vector3d& second = joint_[1].axis;
  // Axis 3 goes to d; R1⁻¹ d must be where joint 2 can carry axis 3: of its height along axis 2,
  //   (d across axis 1)·h₂ cos q1 + (d × h₁)·h₂ sin q1 = h₂·h₃ − (d·h₁)(h₁·h₂).
  // This equation keeps its digits however near d comes to axis 1.
  const Eigen::Vector3d d = rotation * joint_[2].axis;
  const Eigen::Vector3d mark = rotation * mark_;
  const double along = first.dot(d);
  const Eigen::Vector3d across = d - along * first;
  const Eigen::Vector3d beside = d.cross(first);
  const double sine = beside.norm();
  const bool aligned = sine < kWristSine;

  // Cosines and sines of q1, q2, q3 of both roots; their angles are found together.
  std::array<double, 6> cosines{};
  std::array<double, 6> sines{};
  std::array<double, 6> angles{};
  int count = 1;
  if (aligned) {
    cosines[0] = std::cos(held[0]);
    sines[0] = std::sin(held[0]);
  } else {
    const double x = second.dot(across);
    const double y = second.dot(beside);
    const double rest = between_ - along * first.dot(second);
    const double square = x * x + y * y;
    const double size = std::sqrt(square);
    // As far as the slack reaches, the end of the range answers; the orientation is checked anyway.
    if (std::abs(rest) - size > kBoundary) return;
    // cos δ = rest / size; its factors vanish at the ends, so that no digits are lost there.
    const double apart = std::sqrt(std::max(0.0, size - rest) * std::max(0.0, size + rest));
    const double length = std::max(std::hypot(rest, apart) * size, 1e-300);
    count = apart == 0.0 ? 1 : 2;
    cosines[0] = (x * rest - y * apart) / length;
    sines[0] = (y * rest + x * apart) / length;
    cosines[1] = (x * rest + y * apart) / length;
    sines[1] = (y * rest - x * apart) / length;
  }
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<size_t>(i);
    const Eigen::Vector3d turned = turn_back(first, cosines[k], sines[k], d);
    const double c = tilt_.dot(turned);
    const double s = tilt_on_.dot(turned);
    const double scale = 1.0 / std::max(std::sqrt(c * c + s * s), 1e-300);
    cosines[k + 2] = c * scale;
    sines[k + 2] = s * scale;
    const Eigen::Vector3d marked = turn_back(second, cosines[k + 2], sines[k + 2],
                                             turn_back(first, cosines[k], sines[k], mark));
    cosines[k + 4] = mark_.dot(marked);
    sines[k + 4] = mark_on_.dot(marked);
  }
  angles_of(sines, cosines, angles);
  const double side = aligned ? 0.0 : std::asin(std::min(1.0, sine));
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<size_t>(i);
    OrientationRoot& root = found.roots[static_cast<size_t>(found.count++)];
    root.q = {aligned ? held[0] : angles[k], angles[k + 2], angles[k + 4]};
    root.free = aligned;
    root.sign = along > 0.0 ? 1.0 : -1.0;
    root.side = i == 0 ? side : -side;
  }
}

}  // namespace viapoint
