/// @file
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kinematics/closed_form.hpp"
#include "kinematics/joint_turns.hpp"
#include "kinematics/numerical_inverse.hpp"

namespace viapoint {

/// A closed form under joint limits. Immutable. Threads: any.
class ClosedFormInverse final : public InverseKinematics {
 public:
  ClosedFormInverse(const ForwardKinematics& forward, const JointLimits& limits,
                    std::unique_ptr<const ClosedForm> form);

  [[nodiscard]] std::string family() const override;
  [[nodiscard]] std::vector<JointVector> solve_all(const Pose& pose_base_tool) const override;
  [[nodiscard]] JointVector solve_near(const Pose& pose_base_tool,
                                       const JointVector& near) const override;
  [[nodiscard]] std::vector<JointVector> solve_all(const Eigen::Vector3d& position) const override;
  [[nodiscard]] JointVector solve_near(const Eigen::Vector3d& position,
                                       const JointVector& near) const override;
  [[nodiscard]] JointVector solve_near_unlimited(const Pose& pose_base_tool,
                                                 const JointVector& near) const override;

 private:
  /// The branches that the forward kinematics confirms.
  [[nodiscard]] ClosedSolutions branches(const Pose& pose, const JointVector& held) const;
  /// At a wrist singularity: the turn shared out between joints 4 and 6 so that both keep their
  /// limits, joint 4 as near to `held` as that allows. Elsewhere the branch itself.
  [[nodiscard]] std::vector<JointVector> shared(const ClosedBranch& branch,
                                                const JointVector& held) const;
  [[nodiscard]] bool confirmed(const Pose& pose, const JointVector& q) const;

  ForwardKinematics forward_;
  JointLimits limits_;
  JointTurns turns_;
  std::unique_ptr<const ClosedForm> form_;
  /// For the position alone, and where a joint held at a singular pose leaves nothing.
  NumericalInverse numerical_;
};

}  // namespace viapoint
