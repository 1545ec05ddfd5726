/// @file
#pragma once

#include <string>
#include <vector>

#include "kinematics/joint_turns.hpp"
#include "kinematics/numerical_inverse.hpp"
#include "kinematics/spherical_wrist.hpp"

namespace viapoint {

/// The closed form of SphericalWrist under joint limits. Immutable. Threads: any.
class SphericalWristInverse final : public InverseKinematics {
 public:
  SphericalWristInverse(const ForwardKinematics& forward, const JointLimits& limits,
                        const SphericalWrist& wrist);

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
  /// The branches that the forward kinematics confirms. @throws MotionError(kUnreachable)
  [[nodiscard]] std::vector<WristBranch> branches(const Pose& pose, const JointVector& held) const;
  /// At a wrist singularity: the turn shared out between joints 4 and 6 so that both keep their
  /// limits, joint 4 as near to `held` as that allows. Elsewhere the branch itself.
  [[nodiscard]] std::vector<JointVector> shared(const WristBranch& branch,
                                                const JointVector& held) const;
  [[nodiscard]] bool confirmed(const Pose& pose, const JointVector& q) const;

  ForwardKinematics forward_;
  JointLimits limits_;
  JointTurns turns_;
  SphericalWrist wrist_;
  NumericalInverse position_;  ///< for questions about the position alone
};

}  // namespace viapoint
