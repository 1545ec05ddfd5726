/// @file
#pragma once

#include <optional>
#include <vector>

#include "kinematics/closed_form.hpp"
#include "kinematics/inverse_errors.hpp"
#include "kinematics/joint_turns.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {

/// What every solver has: the chain, its limits, and the checks of what is asked. The solvers
/// answer InverseTasks, a pose or a position alike.
class LimitedInverse : public InverseKinematics {
 public:
  using InverseKinematics::solve_all;
  [[nodiscard]] std::vector<JointVector> solve_all(const Pose& pose_base_tool,
                                                   const JointVector& reference) const final;
  [[nodiscard]] JointVector solve_near(const Pose& pose_base_tool,
                                       const JointVector& near) const final;
  [[nodiscard]] std::vector<JointVector> solve_all(const Eigen::Vector3d& position,
                                                   const JointVector& reference) const final;
  [[nodiscard]] JointVector solve_near(const Eigen::Vector3d& position,
                                       const JointVector& near) const final;
  [[nodiscard]] JointVector solve_near_unlimited(const Pose& pose_base_tool,
                                                 const JointVector& near) const final;
  [[nodiscard]] BranchStatus solve_branches(const Pose& pose_base_tool, const JointVector& near,
                                            BranchSet& branches) const noexcept final;
  [[nodiscard]] Configuration configuration(const JointVector& q) const final;

  /// As solve_all() and its kin say, of arguments that are checked.
  [[nodiscard]] virtual std::vector<JointVector> all(const InverseTask& task,
                                                     const JointVector& reference) const = 0;
  [[nodiscard]] virtual JointVector near(const InverseTask& task,
                                         const JointVector& reference) const = 0;
  [[nodiscard]] virtual JointVector near_unlimited(const InverseTask& task,
                                                   const JointVector& reference) const = 0;
  /// How near q is to each singularity of the arm's own, where a closed form tells; for seven
  /// joints none does, as another joint may make up for it.
  [[nodiscard]] virtual std::optional<ArmSides> singular_sides(const JointVector& q) const;

 protected:
  LimitedInverse(const ForwardKinematics& forward, const JointLimits& limits);
  /// As solve_branches() says, of arguments that are checked and an empty set.
  [[nodiscard]] virtual BranchStatus branches_near(const InverseTask& task, const JointVector& near,
                                                   BranchSet& branches) const noexcept;
  /// The sides of q; turns are counted here.
  [[nodiscard]] virtual Configuration sides(const JointVector& q) const;
  [[nodiscard]] int joints() const final { return forward_.joints(); }
  [[nodiscard]] PoseError error(const InverseTask& task, const JointVector& q) const {
    return task.error_of(forward_.pose(q));
  }
  [[nodiscard]] bool confirmed(const InverseTask& task, const JointVector& q) const {
    return error(task, q).within(kPoseTolerance);
  }
  /// Adds every confirmed turn of `branch` within the limits. @return whether there is any turn
  bool add_turns(const InverseTask& task, const JointVector& branch, const JointVector& reference,
                 std::vector<JointVector>& solutions) const;
  static void sort_nearest_first(std::vector<JointVector>& solutions, const JointVector& reference);

  ForwardKinematics forward_;
  JointLimits limits_;
  JointTurns turns_;
};

}  // namespace viapoint
