#include "kinematics/closed_form_inverse.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kinematics/inverse_errors.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {

ClosedFormInverse::ClosedFormInverse(const ForwardKinematics& forward, const JointLimits& limits,
                                     std::unique_ptr<const ClosedForm> form)
    : forward_(forward),
      limits_(limits),
      turns_(forward, limits),
      form_(std::move(form)),
      numerical_(forward, limits, "where the closed form does not answer") {}

std::string ClosedFormInverse::family() const { return form_->family(); }

bool ClosedFormInverse::confirmed(const Pose& pose, const JointVector& q) const {
  return pose_error(forward_.pose(q), pose).within(kPoseTolerance);
}

ClosedSolutions ClosedFormInverse::branches(const Pose& pose, const JointVector& held) const {
  ClosedSolutions solutions = form_->solve(pose, held);
  std::erase_if(solutions.branches,
                [&](const ClosedBranch& branch) { return !confirmed(pose, branch.q); });
  if (solutions.branches.empty() && !solutions.held) {
    refuse_unreachable("the wrist at this pose", solutions.out_of_reach);
  }
  return solutions;
}

std::vector<JointVector> ClosedFormInverse::shared(const ClosedBranch& branch,
                                                   const JointVector& held) const {
  if (!branch.wrist_free) return {branch.q};
  const double low4 = limits_.position_min[3];
  const double high4 = limits_.position_max[3];
  const double low6 = limits_.position_min[5];
  const double high6 = limits_.position_max[5];
  // q4 + s q6 = sum + 2πk: for each k the stretch of q4 that leaves q6 within its limits.
  std::vector<JointVector> out;
  const bool endless = !std::isfinite(low6) || !std::isfinite(high6);
  const int turns = endless ? 0 : static_cast<int>(std::ceil((high6 - low6) / (2.0 * kPi))) + 2;
  for (int k = -turns; k <= turns; ++k) {
    const double sum = branch.wrist_sum + 2.0 * kPi * k;
    const double from = branch.wrist_sign > 0.0 ? sum - high6 : sum + low6;
    const double to = branch.wrist_sign > 0.0 ? sum - low6 : sum + high6;
    const double low = std::max(low4, from);
    const double high = std::min(high4, to);
    if (low > high) continue;
    JointVector q = branch.q;
    q[3] = std::clamp(held[3], low, high);
    q[5] = branch.wrist_sign * (sum - q[3]);
    out.push_back(q);
  }
  if (out.empty()) out.push_back(branch.q);
  return out;
}

std::vector<JointVector> ClosedFormInverse::solve_all(const Pose& pose_base_tool) const {
  require_pose(pose_base_tool);
  const JointVector zero = JointVector::Zero(6);
  std::vector<JointVector> solutions;
  std::vector<JointVector> refused;
  const ClosedSolutions closed = branches(pose_base_tool, zero);
  for (const ClosedBranch& branch : closed.branches) {
    for (const JointVector& candidate : shared(branch, zero)) {
      const std::vector<JointVector> turned = turns_.all(candidate);
      if (turned.empty()) refused.push_back(candidate);
      for (const JointVector& q : turned) {
        if (confirmed(pose_base_tool, q)) solutions.push_back(q);
      }
    }
  }
  if (solutions.empty() && closed.held) return numerical_.solve_all(pose_base_tool);
  if (solutions.empty()) refuse_outside_limits(forward_, turns_, refused);
  std::sort(solutions.begin(), solutions.end(),
            [&](const auto& a, const auto& b) { return is_nearer(a, b, zero); });
  // Branches meet at singular poses: what is found twice is said once.
  constexpr double kSame = 1e-9;
  std::vector<JointVector> distinct;
  for (const JointVector& q : solutions) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const JointVector& other) {
      return (q - other).lpNorm<Eigen::Infinity>() < kSame;
    });
    if (!known) distinct.push_back(q);
  }
  return distinct;
}

JointVector ClosedFormInverse::solve_near(const Pose& pose_base_tool,
                                          const JointVector& near) const {
  require_pose(pose_base_tool);
  require_joints(near, 6, "near");
  std::optional<JointVector> best;
  std::vector<JointVector> refused;
  const ClosedSolutions closed = branches(pose_base_tool, near);
  for (const ClosedBranch& branch : closed.branches) {
    for (const JointVector& candidate : shared(branch, near)) {
      auto q = turns_.nearest(candidate, near);
      if (q && !confirmed(pose_base_tool, *q)) {
        // A joint was set on its limit and misses the pose there: another turn may not need that.
        q.reset();
        for (const JointVector& turn : turns_.all(candidate)) {
          if ((!q || is_nearer(turn, *q, near)) && confirmed(pose_base_tool, turn)) q = turn;
        }
      }
      if (!q) {
        refused.push_back(candidate);
        continue;
      }
      if (!best || is_nearer(*q, *best, near)) best = *q;
    }
  }
  if (!best && closed.held) return numerical_.solve_near(pose_base_tool, near);
  if (!best) refuse_outside_limits(forward_, turns_, refused);
  return *best;
}

JointVector ClosedFormInverse::solve_near_unlimited(const Pose& pose_base_tool,
                                                    const JointVector& near) const {
  require_pose(pose_base_tool);
  require_joints(near, 6, "near");
  std::optional<JointVector> best;
  const ClosedSolutions closed = branches(pose_base_tool, near);
  for (const ClosedBranch& branch : closed.branches) {
    const JointVector q = turns_.unlimited(branch.q, near);
    if (!best || is_nearer(q, *best, near)) best = q;
  }
  if (!best) return numerical_.solve_near_unlimited(pose_base_tool, near);
  return *best;
}

std::vector<JointVector> ClosedFormInverse::solve_all(const Eigen::Vector3d& position) const {
  return numerical_.solve_all(position);
}

JointVector ClosedFormInverse::solve_near(const Eigen::Vector3d& position,
                                          const JointVector& near) const {
  return numerical_.solve_near(position, near);
}

}  // namespace viapoint
