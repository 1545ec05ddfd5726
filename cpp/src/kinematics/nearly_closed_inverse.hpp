/// @file
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/branch_inverse.hpp"

namespace viapoint {

/// An arm whose axes are out of true, as a calibration finds them: each branch of the true arm's
/// closed form is the start of a descent on the arm as it is. Where the closed form has fewer than
/// all branches the search looks for more. Immutable. Threads: any.
class NearlyClosedInverse final : public FormInverse<ClosedForm> {
 public:
  /// Nothing when the arm is too far from every closed form with eight branches.
  [[nodiscard]] static std::unique_ptr<const NearlyClosedInverse> make(
      const ForwardKinematics& forward, const JointLimits& limits);

  [[nodiscard]] std::string family() const override;
  [[nodiscard]] std::vector<JointVector> all(const InverseTask& task,
                                             const JointVector& reference) const override;
  [[nodiscard]] JointVector near(const InverseTask& task,
                                 const JointVector& reference) const override;
  [[nodiscard]] JointVector near_unlimited(const InverseTask& task,
                                           const JointVector& reference) const override;

 private:
  NearlyClosedInverse(const ForwardKinematics& forward, const JointLimits& limits,
                      std::unique_ptr<const ClosedForm> form);
  [[nodiscard]] BranchStatus branches_near(const InverseTask& task, const JointVector& near,
                                           BranchSet& branches) const noexcept override;
  /// How far the form's answers miss the arm's poses, at the most of some seeded ones; nothing
  /// where a descent from them fails.
  [[nodiscard]] std::optional<PoseError> deviation() const;
  /// The solution near `start`, if there is one.
  [[nodiscard]] std::optional<JointVector> polished(const InverseTask& task,
                                                    const JointVector& start) const;
  template <typename Branches>
  [[nodiscard]] bool is_among(const JointVector& q, const Branches& branches) const;
  /// Within the limits, on the turn nearest to `reference`.
  [[nodiscard]] std::optional<JointVector> polished_near(const InverseTask& task,
                                                         const JointVector& start,
                                                         const JointVector& reference) const;

  JointTurns wider_turns_;  ///< under limits as much wider as a descent may move a joint
  PoseError deviation_;
};

}  // namespace viapoint
