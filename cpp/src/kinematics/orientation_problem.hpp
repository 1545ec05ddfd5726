/// @file
/// Which joints turn a body into its orientation: at most three axes through one point.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "kinematics/screw.hpp"

namespace viapoint {

/// One way to turn the body.
struct OrientationRoot {
  std::array<double, 3> q{};
  double side = 0.0;  ///< of three axes: from where two of them are one line, signed [rad]
  bool free = false;  ///< they are one line: only q[0] + sign · q[2] is determined
  double sign = 1.0;
};

struct OrientationRoots {
  int count = 0;
  std::array<OrientationRoot, 2> roots;
};

class OrientationProblem {
 public:
  /// Nothing where neighbouring axes are parallel, or a joint slides.
  [[nodiscard]] static std::optional<OrientationProblem> plan(std::span<const Screw> joints);
  /// R1 R2 R3 = rotation. With fewer than three joints the answer holds only if there is one:
  /// check.
  /// @param held (joints,), for what the rotation leaves free
  void solve(const Eigen::Matrix3d& rotation, std::span<const double> held,
             OrientationRoots& found) const;
  [[nodiscard]] int joints() const { return joints_; }

 private:
  OrientationProblem() = default;
  /// As solve(), of three joints.
  void solve_three(const Eigen::Matrix3d& rotation, std::span<const double> held,
                   OrientationRoots& found) const;

  int joints_ = 0;
  std::array<Screw, 3> joint_;
  // Of three joints, at q = 0:
  double between_ = 0.0;                               ///< cosine of axis 2 to axis 3
  Eigen::Vector3d tilt_ = Eigen::Vector3d::Zero();     ///< of axis 3, the part across axis 2
  Eigen::Vector3d tilt_on_ = Eigen::Vector3d::Zero();  ///< that, turned on by π/2 about axis 2
  Eigen::Vector3d mark_ = Eigen::Vector3d::Zero();     ///< square to axis 3
  Eigen::Vector3d mark_on_ = Eigen::Vector3d::Zero();  ///< that, turned on by π/2 about axis 3
};

}  // namespace viapoint
