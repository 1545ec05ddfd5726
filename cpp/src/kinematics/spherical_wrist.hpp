/// @file
/// Six-axis arms whose last three axes meet in one point (Pieper 1968): the wrist centre depends on
/// three joints, the orientation on the other three, and each half has a closed form.
///
/// Recognised: axis 1 ⟂ axis 2 ∥ axis 3, axes 4, 5, 6 through one point with 4 ⟂ 5 ⟂ 6, with any
/// offset of shoulder, elbow and wrist (PUMA, and most industrial arms with six axes).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

/// One family of solutions, whole turns left aside.
struct WristBranch {
  JointVector q;
  /// At a wrist singularity only q4 + sign · q6 is determined: both turn about one line.
  bool wrist_free = false;
  double wrist_sum = 0.0;   ///< q4 + sign · q6 [rad]
  double wrist_sign = 1.0;  ///< +1 or -1
};

/// What the closed form finds for one pose.
struct WristSolutions {
  std::vector<WristBranch> branches;
  double out_of_reach = 0.0;  ///< how far the wrist centre is out of reach [m]; 0 when it is not
};

/// Nearness to each of the three singularities.
struct WristSingularities {
  double shoulder = 0.0;  ///< wrist centre to the plane of axis 1 parallel to axis 2 [m]
  double elbow = 0.0;     ///< elbow from stretched or folded [rad]
  double wrist = 0.0;     ///< axes 4 and 6 from parallel [rad]
  double length = 0.0;    ///< upper arm + forearm [m], to compare metres with radians
};

/// The geometry of such an arm, read off its chain at q = 0. Immutable. Threads: any.
class SphericalWrist {
 public:
  /// Nothing when the chain is not of this kind.
  [[nodiscard]] static std::optional<SphericalWrist> recognise(const ForwardKinematics& forward);

  /// Every branch (up to eight); where a joint is free it takes its value in `held`.
  [[nodiscard]] WristSolutions solve(const Pose& pose_base_tool, const JointVector& held) const;
  [[nodiscard]] WristSingularities singularities(const JointVector& q) const;

 private:
  SphericalWrist() = default;
  void solve_wrist(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& arm,
                   const JointVector& held, std::vector<WristBranch>& out) const;
  [[nodiscard]] Eigen::Matrix3d arm_rotation(const Eigen::Vector3d& arm) const;

  // Frame S: origin on axis 1 at the height of axis 2, z along axis 1, y along axis 2.
  Pose pose_base_s_ = Pose::Identity();
  Eigen::Vector3d wrist_in_tool_ = Eigen::Vector3d::Zero();  ///< wrist centre in the tool frame
  Eigen::Matrix3d rotation_s_tool_ = Eigen::Matrix3d::Identity();   ///< at q = 0
  Eigen::Matrix3d rotation_s_wrist_ = Eigen::Matrix3d::Identity();  ///< y: axis 5, z: axis 4
  double shoulder_x_ = 0.0;   ///< axis 2 in front of axis 1 [m]
  double side_ = 0.0;         ///< wrist centre along axis 2 [m]
  double upper_ = 0.0;        ///< axis 2 to axis 3 [m]
  double fore_ = 0.0;         ///< axis 3 to wrist centre [m]
  double upper_angle_ = 0.0;  ///< direction of the upper arm at q = 0, from z towards x [rad]
  double fore_angle_ = 0.0;   ///< direction of the forearm at q = 0 [rad]
  double elbow_sign_ = 1.0;   ///< axis 3 along or against axis 2
  double tilt_ = 0.0;         ///< axis 6 from axis 4, about axis 5, at q = 0 [rad]
};

}  // namespace viapoint
