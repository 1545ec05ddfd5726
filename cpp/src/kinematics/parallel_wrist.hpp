/// @file
/// Six-axis arms with three parallel axes 2, 3, 4 (the UR family; Hawkins 2013 solves the same
/// arm): joint 1 by the point where axes 5 and 6 meet, joints 5 and 6 by the tool's direction,
/// joints 2, 3 and 4 as a planar arm.
///
/// Recognised: axis 1 ⟂ axis 2 ∥ 3 ∥ 4, 4 ⟂ 5 ⟂ 6, axes 5 and 6 through one point.
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <string>

#include "kinematics/closed_form.hpp"
#include "kinematics/planar_lanes.hpp"

namespace viapoint {

class ParallelWrist final : public ClosedForm {
 public:
  /// Nothing when the chain is not of this kind; `exactly` is how exactly its axes must be square,
  /// parallel and meet: what they miss by is taken for none [rad and m].
  [[nodiscard]] static std::optional<ParallelWrist> recognise(const ForwardKinematics& forward,
                                                              double exactly = kExactAxes);

  [[nodiscard]] std::string family() const override;
  void solve(const InverseTask& task, const JointVector& held,
             ClosedSolutions& solutions) const override;
  [[nodiscard]] ArmSides sides(const JointVector& q) const override;

 private:
  /// A point of the arm's plane as z + ix: a turn about y by θ multiplies it by e^{iθ}.
  using Planar = std::complex<double>;

  // Lanes: shoulder before, wrist one way and flipped; shoulder behind, the same.

  struct WristLanes {
    std::array<std::array<Lanes, 3>, 3> n;  ///< the tool without joint 1: Ry(sum) Rx(theta) Ry(q6)
    LaneTurn sum;                           ///< of joints 2, 3 and 4
    LaneTurn theta;                         ///< from axes 2, 3, 4 to axis 6
    LaneTurn q6;
    Lanes sine;       ///< of theta, without its sign and before rounding
    Lanes angle_off;  ///< how far the tool misses its orientation [rad]
  };
  /// Where the meeting point is to be, seen from axis 2 [m].
  struct PlaceLanes {
    double z;
    Lanes x;
  };
  /// Joints 2 and 3, with the elbow up and down.
  struct ArmLanes {
    Lanes target_z, target_x;  ///< where axis 4 is to be, seen from axis 2 [m]
    Lanes span;                ///< how far that is [m]
    LaneTurn bend;
    LaneTurn up, down;  ///< direction of the upper arm
    Lanes missing;      ///< out of reach; solved up to kBoundary [m]
    Lanes off_square;   ///< how far axis 4 misses its place, squared [m²]
  };

  ParallelWrist() = default;
  /// @param goal the tool's orientation; @param held joint 6 where the wrist leaves it free [rad]
  [[nodiscard]] WristLanes turn_wrist(const ShoulderTurns& shoulder, const Eigen::Matrix3d& goal,
                                      double held) const;
  /// What follows from joint 6.
  static void finish_wrist(WristLanes& wrist);
  /// @param held joint 2 where the folded arm leaves it free [rad]
  [[nodiscard]] ArmLanes reach_arm(const WristLanes& wrist, const PlaceLanes& place,
                                   double held) const;
  /// Turns wrists by less than the pose's rounding where that makes the arm reach.
  [[nodiscard]] bool nudge_wrist(const ArmLanes& arm, WristLanes& wrist) const;

  Pose pose_s_base_ = Pose::Identity();
  Eigen::Vector3d meeting_in_tool_ = Eigen::Vector3d::Zero();  ///< of axes 5 and 6, in the tool
  Eigen::Matrix3d rotation_tool_wrist_ = Eigen::Matrix3d::Identity();  ///< with the wrist straight
  Eigen::Matrix3d rotation_s_wrist_ = Eigen::Matrix3d::Identity();     ///< x: axis 5, y: axis 4
  double upper_length_ = 0.0;                                          ///< of upper_ [m]
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
