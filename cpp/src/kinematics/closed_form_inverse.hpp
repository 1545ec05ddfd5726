/// @file
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kinematics/branch_inverse.hpp"

namespace viapoint {

/// A closed form under joint limits. Immutable. Threads: any.
class ClosedFormInverse final : public FormInverse<ClosedForm> {
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
  [[nodiscard]] std::optional<ArmSides> singular_sides(const JointVector& q) const override {
    return form_->sides(q);
  }

 private:
  [[nodiscard]] BranchStatus branches_near(const InverseTask& task, const JointVector& near,
                                           BranchSet& branches) const noexcept override;
  /// The distinct branches that the forward kinematics confirms.
  void branches(const InverseTask& task, const JointVector& held, ClosedSolutions& found) const;
  /// Whether the form's own forward kinematics is the arm's, to rounding.
  [[nodiscard]] bool models_exactly() const;
  /// Nothing within the limits was found.
  [[noreturn]] void refuse(const InverseTask& task, const ClosedSolutions& found,
                           const JointVector& held) const;

  bool trusted_ = false;
};

}  // namespace viapoint
