/// @file
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "kinematics/closed_form.hpp"
#include "kinematics/forward_walk.hpp"
#include "kinematics/limited_inverse.hpp"
#include "kinematics/numerical_inverse.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {

/// What solvers do with the branches of a closed form: confirm, bring within limits, name.
class BranchInverse : public LimitedInverse {
 protected:
  BranchInverse(const ForwardKinematics& forward, const JointLimits& limits);

  /// Two branches are one when no joint differs by more than this, whole turns aside [rad or m].
  static constexpr double kSame = 1e-9;

  [[nodiscard]] bool are_same(const JointVector& a, const JointVector& b) const;
  [[nodiscard]] static Configuration configuration_of(const ArmSides& sides);
  /// Leaves the distinct branches that the forward kinematics confirms. Real-time: safe.
  void keep_confirmed(const InverseTask& task, ClosedSolutions& found) const;
  /// Calls visit(q) for the branch, or, where its wrist is free, for each stretch of whole turns:
  /// the turn shared out so that both wrist joints keep their limits.
  template <typename Visit>
  void each_share(const ClosedBranch& branch, const JointVector& held, Visit&& visit) const;
  /// Every confirmed branch on its turn nearest to `near` within the limits. Moves the branches in
  /// `found`. Real-time: safe.
  void gather(const InverseTask& task, const JointVector& near, ClosedSolutions& found,
              BranchSet& out) const;
  /// The confirmed turn of a candidate nearest to `reference` within the limits.
  [[nodiscard]] std::optional<JointVector> nearest(const InverseTask& task,
                                                   const JointVector& candidate,
                                                   const JointVector& reference) const;

  WalkedChain walked_;
  NumericalInverse numerical_;  ///< for tasks the form cannot answer, and joints held badly
};

template <typename Visit>
void BranchInverse::each_share(const ClosedBranch& branch, const JointVector& held,
                               Visit&& visit) const {
  if (!branch.wrist_free) {
    visit(branch.q);
    return;
  }
  const double low_first = limits_.position_min[branch.first];
  const double high_first = limits_.position_max[branch.first];
  const double low_second = limits_.position_min[branch.second];
  const double high_second = limits_.position_max[branch.second];
  // q_first + s q_second = sum + 2πk: for each k the stretch of q_first that leaves q_second within
  // its limits.
  const double reach = high_second - low_second;
  const int turns = std::isfinite(reach) ? static_cast<int>(std::ceil(reach / (2.0 * kPi))) + 2 : 0;
  bool any = false;
  for (int k = -turns; k <= turns; ++k) {
    const double sum = branch.wrist_sum + 2.0 * kPi * k;
    const double from = branch.wrist_sign > 0.0 ? sum - high_second : sum + low_second;
    const double to = branch.wrist_sign > 0.0 ? sum - low_second : sum + high_second;
    const double low = std::max(low_first, from);
    const double high = std::min(high_first, to);
    if (low > high) continue;
    any = true;
    JointVector q = branch.q;
    const auto share = [&](double first) {
      q[branch.first] = first;
      q[branch.second] = branch.wrist_sign * (sum - first);
      visit(q);
    };
    share(std::clamp(held[branch.first], low, high));
    // Coupled joints may need another share.
    if (limits_.couplings() == 0 || !std::isfinite(high - low)) continue;
    constexpr int kShares = 8;
    for (int i = 0; i <= kShares; ++i) share(low + (high - low) * i / kShares);
  }
  if (!any) visit(branch.q);
}

/// With the form that finds the branches. @tparam Form ClosedForm or RedundantForm
template <typename Form>
class FormInverse : public BranchInverse {
 public:
  FormInverse(const ForwardKinematics& forward, const JointLimits& limits,
              std::unique_ptr<const Form> form)
      : BranchInverse(forward, limits), form_(std::move(form)) {}

 protected:
  [[nodiscard]] Configuration sides(const JointVector& q) const override {
    return configuration_of(form_->sides(q));
  }

  std::unique_ptr<const Form> form_;
};

}  // namespace viapoint
