/// @file
/// Which joints follow a tool curve where the arm has one more than the curve takes.
#pragma once

#include <span>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/path/task_curve.hpp"

namespace viapoint {

/// Of the joints that hold the curve at s, those with direction(s)·(q − joints(s)) = 0 are taken.
/// Both are C² over the length of the curve.
struct JointGuide {
  JointPath joints;     ///< near joints that hold the curve, at both ends those themselves
  JointPath direction;  ///< about that in which the joints move while the tool stays
};

/// Smooths a way of joints that was found place by place. Each place is moved as the tool allows,
/// so that ∫‖q'‖² over the way is least, a penalty within 5 % of the range to a limit included
/// (Gauss and Newton, by a tridiagonal system; the tool is brought back to the curve after every
/// step). Where the way stays clear of limits, q'' then has no part that does not move the tool.
/// @param way (k,), k >= 3: joints on the curve at equal steps of s, without a jump
/// @param goal_counts keep the last joints as they are, not only their tool pose
/// @param options what the joints hold; @pre it takes one coordinate less than there are joints
/// @throws MotionError(kBadArgument) for a way that is shorter. Real-time: not. Threads: any.
[[nodiscard]] JointGuide smooth_guide(const ForwardKinematics& arm, const JointLimits& limits,
                                      const TaskCurve& curve, std::span<const JointVector> way,
                                      bool goal_counts, const InsertionOptions& options);

}  // namespace viapoint
