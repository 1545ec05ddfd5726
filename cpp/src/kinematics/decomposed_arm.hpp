/// @file
/// Arms that come apart into two: some joints carry a point to its place, and the others, whose
/// axes all pass through that point, turn the tool about it. Any mixture of turning and sliding
/// joints: Cartesian, cylindrical, polar, SCARA and planar arms, arms with five axes, and arms with
/// six whose wrist, or shoulder, meets in one point at any angles (Pieper 1968).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinematics/closed_form.hpp"
#include "kinematics/joint_sieve.hpp"
#include "kinematics/orientation_problem.hpp"
#include "kinematics/position_problem.hpp"

namespace viapoint {

/// A chain of at most six joints, each as the base sees it at q = 0. Immutable. Threads: any.
class Decomposition {
 public:
  /// Nothing when the chain does not come apart; accepted only if it finds joints again.
  [[nodiscard]] static std::optional<Decomposition> find(std::span<const Screw> joints,
                                                         const Eigen::Vector3d& tool);
  /// E1 … En = motion, the motion of the tool from where it is at q = 0.
  /// @param sieve branches whose placing joints do not pass it are left out; so many squares of
  /// other joints come to theirs: `before`
  void solve(const Pose& motion, const JointVector& held, ClosedSolutions& solutions,
             const JointSieve& sieve = {}, double before = 0.0) const;
  [[nodiscard]] std::string describe() const;

 private:
  Decomposition() = default;
  [[nodiscard]] bool finds_joints_again() const;
  void name_choices();

  std::vector<Screw> joints_;  ///< in the order solved: from the base, or from the tool
  bool inverted_ = false;      ///< from the tool: the shoulder, not the wrist, meets in one point
  Eigen::Vector3d point_ = Eigen::Vector3d::Zero();
  std::optional<PositionProblem> position_;
  std::optional<OrientationProblem> orientation_;
  std::array<std::optional<double> ArmSides::*, 3> placing_side_{};  ///< what each choice is called
  std::optional<double> ArmSides::* turning_side_ = nullptr;
  double elbow_sign_ = 1.0;
};

class DecomposedArm final : public ClosedForm {
 public:
  /// Nothing when the chain is not of this kind.
  [[nodiscard]] static std::optional<DecomposedArm> recognise(const ForwardKinematics& forward);

  [[nodiscard]] std::string family() const override;
  [[nodiscard]] bool answers(const InverseTask& task) const override;
  void solve(const InverseTask& task, const JointVector& held,
             ClosedSolutions& solutions) const override;
  [[nodiscard]] ArmSides sides(const JointVector& q) const override;

 private:
  DecomposedArm(ForwardKinematics forward, Decomposition decomposition);

  ForwardKinematics forward_;
  Decomposition decomposition_;
  std::optional<PositionProblem> placing_;  ///< of the tool's point, by the first joints alone
  int placing_joints_ = 0;
  Pose tool_inverse_ = Pose::Identity();  ///< of the tool at q = 0
  Eigen::Vector3d tool_ = Eigen::Vector3d::Zero();
};

/// The joints of a chain at q = 0.
[[nodiscard]] std::vector<Screw> screws_of(const ForwardKinematics& forward);

}  // namespace viapoint
