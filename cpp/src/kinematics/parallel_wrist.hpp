/// @file
/// Six-axis arms with three parallel axes 2, 3, 4 (the UR family; Hawkins 2013 solves the same
/// arm): joint 1 by the point where axes 5 and 6 meet, joints 5 and 6 by the tool's direction,
/// joints 2, 3 and 4 as a planar arm.
///
/// Recognised: axis 1 ⟂ axis 2 ∥ 3 ∥ 4, 4 ⟂ 5 ⟂ 6, axes 5 and 6 through one point.
#pragma once

#include <complex>
#include <optional>
#include <string>

#include "kinematics/closed_form.hpp"

namespace viapoint {

class ParallelWrist final : public ClosedForm {
 public:
  /// Nothing when the chain is not of this kind.
  [[nodiscard]] static std::optional<ParallelWrist> recognise(const ForwardKinematics& forward);

  [[nodiscard]] std::string family() const override;
  void solve(const InverseTask& task, const JointVector& held,
             ClosedSolutions& solutions) const override;
  [[nodiscard]] ArmSides sides(const JointVector& q) const override;

 private:
  /// A point of the arm's plane as z + ix: a turn about y by θ multiplies it by e^{iθ}.
  using Planar = std::complex<double>;

  /// The wrist's joints, and the sine of the angle between axis 6 and axes 2, 3, 4.
  struct Wrist {
    double q5, q6, sine;
  };

  ParallelWrist() = default;
  /// Joints 2, 3, 4 for a wrist. @param rotation what is left of the tool's without joint 1
  /// @param place of the meeting point seen from axis 2
  void solve_arm(const Eigen::Matrix3d& rotation, double q1, const Planar& place, Wrist wrist,
                 const JointVector& held, ClosedSolutions& solutions) const;

  Pose pose_s_base_ = Pose::Identity();
  Eigen::Vector3d meeting_in_tool_ = Eigen::Vector3d::Zero();      ///< of axes 5 and 6, in the tool
  Eigen::Matrix3d rotation_s_tool_ = Eigen::Matrix3d::Identity();  ///< at q = 0
  Eigen::Vector3d axis5_ = Eigen::Vector3d::UnitZ();               ///< in S, at q = 0
  Eigen::Vector3d axis6_ = Eigen::Vector3d::UnitY();
  Eigen::Vector3d axis65_ = Eigen::Vector3d::Zero();        ///< axis 6 × axis 5
  Eigen::Vector3d y_across_ = Eigen::Vector3d::Zero();      ///< axis 6 × y
  Eigen::Vector3d aside_across_ = Eigen::Vector3d::Zero();  ///< axis 6 × (axis 5 × y)
  double cos_tilt_ = 1.0;
  double sin_tilt_ = 0.0;
  double upper_length_ = 0.0;  ///< of upper_ [m]
  double fore_length_ = 0.0;
  double upper_angle_ = 0.0;  ///< of upper_, from z towards x [rad]
  double turn3_zero_ = 0.0;   ///< angle from forearm to upper arm at q = 0 [rad]
  double tilt_ = 0.0;         ///< axis 6 from y, about axis 5, at q = 0 [rad]
  double side_ = 0.0;         ///< meeting point along axis 2 [m]
  Planar shoulder_;           ///< axis 2
  Planar upper_;              ///< axis 2 to axis 3
  Planar fore_;               ///< axis 3 to axis 4
  Planar hand_;               ///< axis 4 to the meeting point
  double sign3_ = 1.0;        ///< axis 3 along or against axis 2
  double sign4_ = 1.0;        ///< axis 4 along or against axis 2
};

}  // namespace viapoint
