/// @file
/// Joints along a way that is told as poses, without a jump.
#pragma once

#include <span>
#include <vector>

#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint {

/// A joint that changes by more between two poses has jumped [rad or m].
inline constexpr double kLargestStep = 0.2;

/// Joints that hold the poses one after the other and stay on one branch: no joint changes by more
/// than `largest_step` from one pose to the next. Each pose takes the solution nearest to the one
/// before; where that leads to a jump, all branches are followed at once from the start, and with
/// seven joints a grid over what the pose leaves open besides, and the way with the least sum of
/// squared steps is taken (shortest path through layers, Bellman 1957). Arms without a closed form:
/// as far as their search finds the branches.
/// @param poses pose_base_tool, (k,), k ≥ 1
/// @param start the solution of the first pose nearest to these joints begins the way [rad or m]
/// @param goal joints of the last pose that the way has to end at; null where any that hold it do
/// @return (k,)
/// @throws MotionError(kBranchChange) with share, joint, value and limit where every choice ends:
/// a limit, or a singularity passed too near; kUnreachable, kOutsideLimits, kUncontrolled with the
/// share where a pose has no solution at all; kBadArgument
/// Real-time: not. Threads: any.
[[nodiscard]] std::vector<JointVector> follow_poses(const RobotModel& robot,
                                                    std::span<const Pose> poses,
                                                    const JointVector& start,
                                                    double largest_step = kLargestStep,
                                                    const JointVector* goal = nullptr);

}  // namespace viapoint
