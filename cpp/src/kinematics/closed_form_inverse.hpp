/// @file
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kinematics/closed_form.hpp"
#include "kinematics/numerical_inverse.hpp"

namespace viapoint {

/// A closed form under joint limits. Immutable. Threads: any.
class ClosedFormInverse final : public LimitedInverse {
 public:
  ClosedFormInverse(const ForwardKinematics& forward, const JointLimits& limits,
                    std::unique_ptr<const ClosedForm> form);

  [[nodiscard]] std::string family() const override { return form_->family(); }
  [[nodiscard]] std::vector<JointVector> all(const InverseTask& task,
                                             const JointVector& reference) const override;
  [[nodiscard]] JointVector near(const InverseTask& task,
                                 const JointVector& reference) const override;
  [[nodiscard]] JointVector near_unlimited(const InverseTask& task,
                                           const JointVector& reference) const override;
  [[nodiscard]] BranchStatus solve_branches(const Pose& pose_base_tool, const JointVector& near,
                                            BranchSet& branches) const noexcept override;

 private:
  [[nodiscard]] Configuration sides(const JointVector& q) const override;
  /// The distinct branches that the forward kinematics confirms.
  void branches(const InverseTask& task, const JointVector& held, ClosedSolutions& found) const;
  /// Calls visit(q) for the branch, or, where its wrist is free, for each stretch of whole turns:
  /// the turn shared out so that both wrist joints keep their limits.
  template <typename Visit>
  void each_share(const ClosedBranch& branch, const JointVector& held, Visit&& visit) const;
  /// The confirmed turn of a candidate nearest to `reference` within the limits.
  [[nodiscard]] std::optional<JointVector> nearest(const InverseTask& task,
                                                   const JointVector& candidate,
                                                   const JointVector& reference) const;
  /// Nothing within the limits was found.
  [[noreturn]] void refuse(const InverseTask& task, const ClosedSolutions& found,
                           const JointVector& held) const;

  std::unique_ptr<const ClosedForm> form_;
  NumericalInverse numerical_;  ///< for tasks the form cannot answer, and joints held badly
};

}  // namespace viapoint
