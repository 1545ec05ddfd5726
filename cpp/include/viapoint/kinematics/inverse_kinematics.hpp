/// @file
/// From a pose to joints. Each family of arms has a solver of its own; all keep the joint limits.
#pragma once

#include <string>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/pose.hpp"
#include "viapoint/kinematics/branch_set.hpp"
#include "viapoint/kinematics/configuration.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

/// Solves pose_base_tool = fk(q). Immutable. Real-time: not, but for solve_branches(). Threads:
/// any, at once. Every returned q lies within position and coupled limits and reproduces the pose
/// to 1e-9 m and 1e-9 rad (checked through the forward kinematics, never assumed).
class InverseKinematics {
 public:
  virtual ~InverseKinematics() = default;

  /// Which solver, and why: e.g. "spherical wrist: axes 4, 5, 6 meet in one point".
  [[nodiscard]] virtual std::string family() const = 0;

  /// Every distinct solution within the limits, ±360° turns included, nearest to `reference` first
  /// (see solve_near). A joint that the pose leaves free stays where `reference` has it. Of joints
  /// without limits only the turn nearest to `reference` counts. Arms with more joints than the
  /// pose fixes: one solution a configuration. Without a closed form: what the seeded search finds.
  /// @throws MotionError(kUnreachable) with how far out of reach; kOutsideLimits naming the joint
  /// that comes nearest; kUncontrolled where the arm has too few joints for this pose
  [[nodiscard]] virtual std::vector<JointVector> solve_all(const Pose& pose_base_tool,
                                                           const JointVector& reference) const = 0;
  /// The solution within limits nearest to `near`: the largest joint change decides, then the sum
  /// of squares, [rad and m alike]; `near` may itself lie outside the limits. At a singular pose
  /// the free joint stays where `near` has it. Arms with more joints than the pose fixes: the
  /// solution that keeps near `near` and away from the limits.
  [[nodiscard]] virtual JointVector solve_near(const Pose& pose_base_tool,
                                               const JointVector& near) const = 0;
  /// The same where only the position counts (arms with fewer than six joints, and any other).
  [[nodiscard]] virtual std::vector<JointVector> solve_all(const Eigen::Vector3d& position,
                                                           const JointVector& reference) const = 0;
  [[nodiscard]] virtual JointVector solve_near(const Eigen::Vector3d& position,
                                               const JointVector& near) const = 0;
  /// As solve_near(pose), but with the joint limits left aside: for study only (timed programs).
  [[nodiscard]] virtual JointVector solve_near_unlimited(const Pose& pose_base_tool,
                                                         const JointVector& near) const = 0;
  /// Without a heap and without exceptions: every branch on its turn nearest to `near` within the
  /// limits. Seven joints: every branch with the redundancy that `near` has; kUnreachable then says
  /// so for that value only. Real-time: safe. @return kNoClosedForm where the arm has none
  [[nodiscard]] virtual BranchStatus solve_branches(const Pose& pose_base_tool,
                                                    const JointVector& near,
                                                    BranchSet& branches) const noexcept = 0;
  /// Sides and turns of q. Arms without a closed form have turns only.
  /// @throws MotionError(kBadArgument)
  [[nodiscard]] virtual Configuration configuration(const JointVector& q) const = 0;

  /// What an arm of seven joints leaves open once the pose is given, "arm angle" or "joint 7";
  /// empty for all others.
  [[nodiscard]] virtual std::string redundancy() const { return {}; }
  /// Its value at q [rad]. @throws MotionError(kUncontrolled) for arms that leave nothing open
  [[nodiscard]] virtual double redundancy_of(const JointVector& q) const;
  /// Every solution within the limits with this value of it [rad], nearest to `reference` first.
  /// @throws MotionError as solve_all(), and kUncontrolled for arms that leave nothing open
  [[nodiscard]] virtual std::vector<JointVector> solve_all_at(const Pose& pose_base_tool,
                                                              double redundancy,
                                                              const JointVector& reference) const;

  /// As above, nearest to zero first.
  [[nodiscard]] std::vector<JointVector> solve_all(const Pose& pose_base_tool) const;
  [[nodiscard]] std::vector<JointVector> solve_all(const Eigen::Vector3d& position) const;
  /// Those of solve_all() that stand as `wish` says.
  /// @throws MotionError also kOutsideLimits when there is none, naming the ones there are
  [[nodiscard]] std::vector<JointVector> solve_all(const Pose& pose_base_tool,
                                                   const JointVector& reference,
                                                   const Configuration& wish) const;
  /// Those of `solutions` that stand as `wish` says; the wish for any keeps them all. @throws as
  /// above
  [[nodiscard]] std::vector<JointVector> in_configuration(std::vector<JointVector> solutions,
                                                          const Configuration& wish) const;

 protected:
  [[nodiscard]] virtual int joints() const = 0;
};

}  // namespace viapoint
