/// @file
/// Arms with seven joints: with one number more than the pose, the joints follow in closed form.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "kinematics/decomposed_arm.hpp"

namespace viapoint {

/// Immutable. Threads: any.
class RedundantForm {
 public:
  virtual ~RedundantForm() = default;
  [[nodiscard]] virtual std::string family() const = 0;
  /// What the parameter is, in words.
  [[nodiscard]] virtual std::string parameter() const = 0;
  [[nodiscard]] virtual double parameter_of(const JointVector& q) const = 0;
  /// Every branch with this value of the parameter [rad], but for those that a part of their joints
  /// shows not to pass the sieve.
  virtual void solve(const Pose& pose_base_tool, double parameter, const JointVector& held,
                     ClosedSolutions& solutions, const JointSieve& sieve = {}) const = 0;
  [[nodiscard]] virtual ArmSides sides(const JointVector& q) const = 0;
  /// Between which values the parameter may lie [rad].
  [[nodiscard]] virtual std::pair<double, double> range(const JointLimits& limits) const = 0;
};

/// Three axes that meet in the shoulder, an elbow, three that meet in the wrist (KUKA iiwa): the
/// parameter is the arm angle, of the arm's plane about the line from shoulder to wrist, from the
/// plane that holds axis 1 (Hollerbach 1985; Shimizu et al. 2008).
class ArmAngleForm final : public RedundantForm {
 public:
  [[nodiscard]] static std::optional<ArmAngleForm> recognise(const ForwardKinematics& forward);
  [[nodiscard]] std::string family() const override;
  [[nodiscard]] std::string parameter() const override { return "arm angle"; }
  [[nodiscard]] double parameter_of(const JointVector& q) const override;
  void solve(const Pose& pose_base_tool, double parameter, const JointVector& held,
             ClosedSolutions& solutions, const JointSieve& sieve) const override;
  [[nodiscard]] ArmSides sides(const JointVector& q) const override;
  [[nodiscard]] std::pair<double, double> range(const JointLimits& limits) const override;

 private:
  ArmAngleForm() = default;
  /// Square to `along` and to axis 1: the normal of the plane from which the arm angle counts.
  [[nodiscard]] Eigen::Vector3d reference_normal(const Eigen::Vector3d& along) const;

  std::vector<Screw> joints_;
  Eigen::Vector3d shoulder_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d wrist_ = Eigen::Vector3d::Zero();  ///< at q = 0
  Track bend_;                                       ///< of the wrist, about joint 4
  JointTerm square_;                                 ///< of its distance from the shoulder
  std::optional<OrientationProblem> upper_;          ///< joints 1, 2, 3
  std::optional<OrientationProblem> lower_;          ///< joints 5, 6, 7
  Pose tool_inverse_ = Pose::Identity();
};

/// Arms whose first six joints come apart once the last one is known (Franka: He & Liu 2021): the
/// parameter is the last joint.
class LastJointForm final : public RedundantForm {
 public:
  [[nodiscard]] static std::optional<LastJointForm> recognise(const ForwardKinematics& forward);
  [[nodiscard]] std::string family() const override;
  [[nodiscard]] std::string parameter() const override { return "joint 7"; }
  [[nodiscard]] double parameter_of(const JointVector& q) const override { return q[6]; }
  void solve(const Pose& pose_base_tool, double parameter, const JointVector& held,
             ClosedSolutions& solutions, const JointSieve& sieve) const override;
  [[nodiscard]] ArmSides sides(const JointVector& q) const override;
  [[nodiscard]] std::pair<double, double> range(const JointLimits& limits) const override;

 private:
  LastJointForm(ForwardKinematics forward, Decomposition decomposition);
  ForwardKinematics forward_;
  Decomposition decomposition_;
  Screw last_;
  Pose tool_inverse_ = Pose::Identity();
};

/// The form for this chain, or nothing.
[[nodiscard]] std::unique_ptr<const RedundantForm> recognise_redundant_form(
    const ForwardKinematics& forward);

}  // namespace viapoint
