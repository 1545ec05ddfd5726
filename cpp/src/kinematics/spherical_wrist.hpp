/// @file
/// Six-axis arms whose last three axes meet in one point (Pieper 1968): the wrist centre depends on
/// three joints, the orientation on the other three, and each half has a closed form.
///
/// Recognised: axis 1 ⟂ axis 2 ∥ axis 3, axes 4, 5, 6 through one point with 4 ⟂ 5 ⟂ 6, with any
/// offset of shoulder, elbow and wrist (PUMA, and most industrial arms with six axes).
#pragma once

#include <optional>
#include <string>

#include "kinematics/closed_form.hpp"
#include "kinematics/planar_lanes.hpp"

namespace viapoint {

/// The geometry of such an arm, read off its chain at q = 0. Immutable. Threads: any.
class SphericalWrist final : public ClosedForm {
 public:
  /// Nothing when the chain is not of this kind; `exactly` is how exactly its axes must be square,
  /// parallel and meet: what they miss by is taken for none [rad and m].
  [[nodiscard]] static std::optional<SphericalWrist> recognise(const ForwardKinematics& forward,
                                                               double exactly = kExactAxes);

  [[nodiscard]] std::string family() const override;
  void solve(const InverseTask& task, const JointVector& held,
             ClosedSolutions& solutions) const override;
  [[nodiscard]] ArmSides sides(const JointVector& q) const override;

 private:
  SphericalWrist() = default;
  /// The wrist of four arms, bent one way.
  struct WristLanes {
    LaneTurn q4;
    LaneTurn theta;  ///< from axis 4 to axis 6, in [0, π]
    LaneTurn q6;
    Lanes sine;       ///< of theta, before rounding; small where the two axes are in line
    Lanes angle_off;  ///< how far the tool misses its orientation [rad]
  };
  /// @param first joint 1; @param fore joints 2 and 3 together; @param goal the tool's orientation
  /// @param held joint 4 where the wrist leaves it free [rad]
  [[nodiscard]] WristLanes turn_wrist(const LaneTurn& first, const LaneTurn& fore,
                                      const Eigen::Matrix3d& goal, double held) const;

  // Frame S: origin on axis 1 at the height of axis 2, z along axis 1, y along axis 2.
  Pose pose_s_base_ = Pose::Identity();
  Eigen::Vector3d wrist_in_tool_ = Eigen::Vector3d::Zero();  ///< wrist centre in the tool frame
  Eigen::Matrix3d rotation_tool_wrist_ = Eigen::Matrix3d::Identity();  ///< with the wrist straight
  Eigen::Matrix3d rotation_s_wrist_ = Eigen::Matrix3d::Identity();     ///< y: axis 5, z: axis 4
  double shoulder_x_ = 0.0;   ///< axis 2 in front of axis 1 [m]
  double side_ = 0.0;         ///< wrist centre along axis 2 [m]
  double upper_ = 0.0;        ///< axis 2 to axis 3 [m]
  double fore_ = 0.0;         ///< axis 3 to wrist centre [m]
  double upper_angle_ = 0.0;  ///< direction of the upper arm at q = 0, from z towards x [rad]
  double fore_angle_ = 0.0;   ///< direction of the forearm at q = 0 [rad]
  LaneTurn fore_zero_;        ///< turn by -fore_angle_
  double elbow_sign_ = 1.0;   ///< axis 3 along or against axis 2
  double tilt_ = 0.0;         ///< axis 6 from axis 4, about axis 5, at q = 0 [rad]
};

}  // namespace viapoint
