#include "kinematics/closed_form.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/decomposed_arm.hpp"
#include "kinematics/parallel_wrist.hpp"
#include "kinematics/spherical_wrist.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {

std::unique_ptr<const ClosedForm> recognise_closed_form(const ForwardKinematics& forward) {
  if (auto arm = SphericalWrist::recognise(forward)) {
    return std::make_unique<SphericalWrist>(*arm);
  }
  if (auto arm = ParallelWrist::recognise(forward)) return std::make_unique<ParallelWrist>(*arm);
  if (auto arm = DecomposedArm::recognise(forward)) {
    return std::make_unique<DecomposedArm>(*std::move(arm));
  }
  return nullptr;
}

std::unique_ptr<const ClosedForm> recognise_nearly_closed_form(const ForwardKinematics& forward) {
  if (auto arm = SphericalWrist::recognise(forward, kNearlyExactAxes)) {
    return std::make_unique<SphericalWrist>(*arm);
  }
  if (auto arm = ParallelWrist::recognise(forward, kNearlyExactAxes)) {
    return std::make_unique<ParallelWrist>(*arm);
  }
  return nullptr;
}

std::optional<Eigen::Vector3d> nearest_point(const Eigen::Vector3d& origin_a,
                                             const Eigen::Vector3d& axis_a,
                                             const Eigen::Vector3d& origin_b,
                                             const Eigen::Vector3d& axis_b) {
  const Eigen::Vector3d normal = axis_a.cross(axis_b);
  const double square = normal.squaredNorm();
  if (square < 1e-6) return std::nullopt;
  const double along = (origin_b - origin_a).cross(axis_b).dot(normal) / square;
  return origin_a + along * axis_a;
}

Pose shoulder_frame(const ChainFrames& zero) {
  const Eigen::Vector3d& turn = zero.axis[0];
  Pose frame = Pose::Identity();
  frame.linear().col(2) = turn;
  frame.linear().col(1) = (zero.axis[1] - turn.dot(zero.axis[1]) * turn).normalized();
  frame.linear().col(0) = frame.linear().col(1).cross(turn);
  frame.translation() = zero.origin[0] + turn.dot(zero.origin[1] - zero.origin[0]) * turn;
  return frame;
}

Eigen::Matrix3d about_y(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Eigen::Matrix3d out;
  out << c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c;
  return out;
}

Eigen::Matrix3d about_z(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Eigen::Matrix3d out;
  out << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return out;
}

double from_half_turns(double angle) {
  return std::copysign(std::remainder(angle, kPi), std::sin(angle));
}

}  // namespace viapoint
