#include "kinematics/limited_inverse.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// The whole turns of an angle; exactly half a turn belongs to (-π, π], whatever its rounding.
int turn_of(double angle) {
  constexpr double kRounding = 1e-12;
  return static_cast<int>(std::ceil((angle - kPi) / (2.0 * kPi) - kRounding));
}

}  // namespace

LimitedInverse::LimitedInverse(const ForwardKinematics& forward, const JointLimits& limits)
    : forward_(forward), limits_(limits), turns_(forward, limits) {}

std::vector<JointVector> LimitedInverse::solve_all(const Pose& pose_base_tool,
                                                   const JointVector& reference) const {
  require_pose(pose_base_tool);
  require_joints(reference, joints(), "reference");
  return all(InverseTask(pose_base_tool), reference);
}

JointVector LimitedInverse::solve_near(const Pose& pose_base_tool,
                                       const JointVector& reference) const {
  require_pose(pose_base_tool);
  require_joints(reference, joints(), "near");
  return near(InverseTask(pose_base_tool), reference);
}

std::vector<JointVector> LimitedInverse::solve_all(const Eigen::Vector3d& position,
                                                   const JointVector& reference) const {
  require_position(position);
  require_joints(reference, joints(), "reference");
  return all(InverseTask(position), reference);
}

JointVector LimitedInverse::solve_near(const Eigen::Vector3d& position,
                                       const JointVector& reference) const {
  require_position(position);
  require_joints(reference, joints(), "near");
  return near(InverseTask(position), reference);
}

JointVector LimitedInverse::solve_near_unlimited(const Pose& pose_base_tool,
                                                 const JointVector& reference) const {
  require_pose(pose_base_tool);
  require_joints(reference, joints(), "near");
  return near_unlimited(InverseTask(pose_base_tool), reference);
}

BranchStatus LimitedInverse::solve_branches(const Pose& pose_base_tool, const JointVector& near,
                                            BranchSet& branches) const noexcept {
  branches.clear();
  if (near.size() != joints() || !near.allFinite() || !is_pose(pose_base_tool)) {
    return BranchStatus::kBadArgument;
  }
  return branches_near(InverseTask(pose_base_tool), near, branches);
}

BranchStatus LimitedInverse::branches_near(const InverseTask&, const JointVector&,
                                           BranchSet&) const noexcept {
  return BranchStatus::kNoClosedForm;
}

bool LimitedInverse::add_turns(const InverseTask& task, const JointVector& branch,
                               const JointVector& reference,
                               std::vector<JointVector>& solutions) const {
  const std::vector<JointVector> turned = turns_.all(branch, reference);
  for (const JointVector& q : turned) {
    if (confirmed(task, q)) solutions.push_back(q);
  }
  return !turned.empty();
}

void LimitedInverse::sort_nearest_first(std::vector<JointVector>& solutions,
                                        const JointVector& reference) {
  std::sort(solutions.begin(), solutions.end(),
            [&](const auto& a, const auto& b) { return is_nearer(a, b, reference); });
}

std::optional<ArmSides> LimitedInverse::singular_sides(const JointVector&) const {
  return std::nullopt;
}

Configuration LimitedInverse::sides(const JointVector&) const { return {}; }

Configuration LimitedInverse::configuration(const JointVector& q) const {
  require_joints(q, joints(), "q");
  Configuration found = sides(q);
  found.turns = TurnVector::Zero(joints());
  for (int i = 0; i < joints(); ++i) {
    if (forward_.type(i) == JointType::kRevolute) found.turns[i] = turn_of(q[i]);
  }
  return found;
}

}  // namespace viapoint
