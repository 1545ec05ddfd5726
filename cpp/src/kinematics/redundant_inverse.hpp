/// @file
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kinematics/branch_inverse.hpp"
#include "kinematics/configuration_sweep.hpp"
#include "kinematics/redundant_form.hpp"

namespace viapoint {

/// Seven joints in closed form, the parameter chosen here: near the reference when there is a
/// solution near it, and otherwise also away from the limits. Immutable. Threads: any.
class RedundantInverse final : public FormInverse<RedundantForm> {
 public:
  RedundantInverse(const ForwardKinematics& forward, const JointLimits& limits,
                   std::unique_ptr<const RedundantForm> form);

  [[nodiscard]] std::string family() const override { return form_->family(); }
  [[nodiscard]] std::string redundancy() const override { return form_->parameter(); }
  [[nodiscard]] double redundancy_of(const JointVector& q) const override;
  [[nodiscard]] std::vector<JointVector> solve_all_at(const Pose& pose_base_tool, double redundancy,
                                                      const JointVector& reference) const override;
  [[nodiscard]] std::vector<JointVector> all(const InverseTask& task,
                                             const JointVector& reference) const override;
  [[nodiscard]] JointVector near(const InverseTask& task,
                                 const JointVector& reference) const override;
  [[nodiscard]] JointVector near_unlimited(const InverseTask& task,
                                           const JointVector& reference) const override;

 private:
  struct Choice {
    JointVector q;
    double parameter = 0.0;
    double cost = 1e300;  ///< 1e300: nothing within the limits
  };
  [[nodiscard]] BranchStatus branches_near(const InverseTask& task, const JointVector& near,
                                           BranchSet& branches) const noexcept override;
  /// The cheapest solution within the limits with this parameter, of those that cost less than
  /// `most`.
  [[nodiscard]] Choice choose(const InverseTask& task, double parameter,
                              const JointVector& reference, double most) const;
  /// The cheapest found between parameter ± half, from `best` on.
  [[nodiscard]] Choice refine(const InverseTask& task, Choice best, double half,
                              const JointVector& reference) const;
  /// The cheapest of `count` parameters over the whole range, refined.
  [[nodiscard]] Choice scan(const InverseTask& task, int count, const JointVector& reference) const;
  /// The squares of all changes from the reference, and what limits add.
  [[nodiscard]] double cost(const JointVector& q, const JointVector& reference) const {
    return (q - reference).squaredNorm() + crowding(q);
  }
  /// How far the wrist is out of reach at the best parameter [m].
  [[nodiscard]] double least_missing(const InverseTask& task, const JointVector& reference) const;
  /// What limits add to a cost: nothing but close to them.
  [[nodiscard]] double crowding(const JointVector& q) const;
  /// Distance from the nearest limit, as a share of that joint's range.
  [[nodiscard]] double margin(const JointVector& q) const;

  ConfigurationSweep sweep_;
};

}  // namespace viapoint
