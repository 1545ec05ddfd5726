/// @file
/// From a pose to joints. Each family of arms has a solver of its own; all keep the joint limits.
#pragma once

#include <string>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/pose.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

/// Solves pose_base_tool = fk(q). Immutable. Real-time: not. Threads: any, at once.
/// Every returned q lies within position and coupled limits and reproduces the pose to 1e-9 m and
/// 1e-9 rad (checked through the forward kinematics, never assumed).
class InverseKinematics {
 public:
  virtual ~InverseKinematics() = default;

  /// Which solver, and why: e.g. "spherical wrist: axes 4, 5, 6 meet in one point".
  [[nodiscard]] virtual std::string family() const = 0;

  /// Every branch within the limits, ±360° turns included, nearest to zero first. For arms without
  /// a closed form: every branch the seeded search finds.
  /// @throws MotionError(kUnreachable) with how far out of reach; kOutsideLimits naming the joint
  /// that comes nearest; kUncontrolled where the arm has too few joints for this pose
  [[nodiscard]] virtual std::vector<JointVector> solve_all(const Pose& pose_base_tool) const = 0;
  /// The branch within limits nearest to `near` (largest joint change first, then the sum of
  /// squares); `near` may itself lie outside the limits. At a singular pose the free joint stays
  /// where `near` has it.
  [[nodiscard]] virtual JointVector solve_near(const Pose& pose_base_tool,
                                               const JointVector& near) const = 0;
  /// The same where only the position counts (arms with fewer than six joints, and any other).
  [[nodiscard]] virtual std::vector<JointVector> solve_all(
      const Eigen::Vector3d& position) const = 0;
  [[nodiscard]] virtual JointVector solve_near(const Eigen::Vector3d& position,
                                               const JointVector& near) const = 0;
  /// As solve_near(pose), but with the joint limits left aside: for study only (timed programs).
  [[nodiscard]] virtual JointVector solve_near_unlimited(const Pose& pose_base_tool,
                                                         const JointVector& near) const = 0;
};

}  // namespace viapoint
