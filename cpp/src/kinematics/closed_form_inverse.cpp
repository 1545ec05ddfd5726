#include "kinematics/closed_form_inverse.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// Two branches are one when no joint differs by more than this, whole turns aside [rad or m].
constexpr double kSame = 1e-9;
/// Nearer than this to its singularity a side is neither one nor the other: the share that the
/// rounding of a pose leaves of a joint there [rad, or m over the arm's length].
constexpr double kOnSingularity = 1e-7;

int side_of(const std::optional<double>& distance, double unit) {
  if (!distance || std::abs(*distance) < kOnSingularity * unit) return 0;
  return *distance > 0.0 ? 1 : -1;
}

/// The search may still find an answer, or can say what is missing: a joint was held badly, or the
/// wrist is within reach and the forward kinematics denies every branch.
bool undecided(const ClosedSolutions& found) {
  return found.held || (found.branches.empty() && found.out_of_reach == 0.0);
}

}  // namespace

ClosedFormInverse::ClosedFormInverse(const ForwardKinematics& forward, const JointLimits& limits,
                                     std::unique_ptr<const ClosedForm> form)
    : LimitedInverse(forward, limits),
      form_(std::move(form)),
      numerical_(forward, limits, "where the closed form does not answer") {}

Configuration ClosedFormInverse::sides(const JointVector& q) const {
  const ArmSides found = form_->sides(q);
  Configuration out;
  out.shoulder = side_of(found.shoulder, found.length);
  out.elbow = side_of(found.elbow, 1.0);
  out.wrist = side_of(found.wrist, 1.0);
  return out;
}

void ClosedFormInverse::branches(const InverseTask& task, const JointVector& held,
                                 ClosedSolutions& found) const {
  form_->solve(task, held, found);
  const ClosedBranch* first = found.branches.begin();
  // Branches meet at singular poses: what is found twice is kept once. What is kept stands before
  // the one looked at.
  int kept = 0;
  found.branches.keep_if([&](const ClosedBranch& branch) {
    if (!confirmed(task, branch.q)) return false;
    for (int i = 0; i < kept; ++i) {
      const JointVector apart = turns_.unlimited(branch.q, first[i].q) - first[i].q;
      if (apart.lpNorm<Eigen::Infinity>() < kSame) return false;
    }
    ++kept;
    return true;
  });
}

template <typename Visit>
void ClosedFormInverse::each_share(const ClosedBranch& branch, const JointVector& held,
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

std::optional<JointVector> ClosedFormInverse::nearest(const InverseTask& task,
                                                      const JointVector& candidate,
                                                      const JointVector& reference) const {
  std::optional<JointVector> q = turns_.nearest(candidate, reference);
  if (!q || confirmed(task, *q)) return q;
  // A joint was set on its limit and misses the pose there: another turn may not need that.
  q.reset();
  for (const JointVector& turn : turns_.all(candidate, reference)) {
    if ((!q || is_nearer(turn, *q, reference)) && confirmed(task, turn)) q = turn;
  }
  return q;
}

void ClosedFormInverse::refuse(const InverseTask& task, const ClosedSolutions& found,
                               const JointVector& held) const {
  if (found.branches.empty()) {
    refuse_unreachable(task.position_only ? "the position" : "the wrist at this pose",
                       found.out_of_reach);
  }
  std::vector<JointVector> refused;
  for (const ClosedBranch& branch : found.branches) {
    each_share(branch, held, [&](const JointVector& q) { refused.push_back(q); });
  }
  refuse_outside_limits(forward_, turns_, refused);
}

std::vector<JointVector> ClosedFormInverse::all(const InverseTask& task,
                                                const JointVector& reference) const {
  if (!form_->answers(task)) return numerical_.all(task, reference);
  ClosedSolutions found;
  branches(task, reference, found);
  std::vector<JointVector> solutions;
  for (const ClosedBranch& branch : found.branches) {
    each_share(branch, reference, [&](const JointVector& candidate) {
      for (const JointVector& q : turns_.all(candidate, reference)) {
        const bool known = branch.wrist_free &&
                           std::any_of(solutions.begin(), solutions.end(), [&](const auto& other) {
                             return (q - other).template lpNorm<Eigen::Infinity>() < kSame;
                           });
        if (!known && confirmed(task, q)) solutions.push_back(q);
      }
    });
  }
  if (solutions.empty() && undecided(found)) return numerical_.all(task, reference);
  if (solutions.empty()) refuse(task, found, reference);
  std::sort(solutions.begin(), solutions.end(),
            [&](const auto& a, const auto& b) { return is_nearer(a, b, reference); });
  return solutions;
}

JointVector ClosedFormInverse::near(const InverseTask& task, const JointVector& reference) const {
  if (!form_->answers(task)) return numerical_.near(task, reference);
  ClosedSolutions found;
  branches(task, reference, found);
  std::optional<JointVector> best;
  for (const ClosedBranch& branch : found.branches) {
    each_share(branch, reference, [&](const JointVector& candidate) {
      const auto q = nearest(task, candidate, reference);
      if (q && (!best || is_nearer(*q, *best, reference))) best = *q;
    });
  }
  if (best) return *best;
  if (undecided(found)) return numerical_.near(task, reference);
  refuse(task, found, reference);
}

JointVector ClosedFormInverse::near_unlimited(const InverseTask& task,
                                              const JointVector& reference) const {
  ClosedSolutions found;
  if (form_->answers(task)) branches(task, reference, found);
  std::optional<JointVector> best;
  for (const ClosedBranch& branch : found.branches) {
    const JointVector q = turns_.unlimited(branch.q, reference);
    if (!best || is_nearer(q, *best, reference)) best = q;
  }
  return best ? *best : numerical_.near_unlimited(task, reference);
}

BranchStatus ClosedFormInverse::solve_branches(const Pose& pose_base_tool, const JointVector& near,
                                               BranchSet& out) const noexcept {
  out.clear();
  if (near.size() != joints() || !near.allFinite() || !is_pose(pose_base_tool)) {
    return BranchStatus::kBadArgument;
  }
  const InverseTask task(pose_base_tool);
  ClosedSolutions found;
  branches(task, near, found);
  for (const ClosedBranch& branch : found.branches) {
    std::optional<JointVector> best;
    each_share(branch, near, [&](const JointVector& candidate) {
      const auto q = turns_.nearest(candidate, near);
      if (!q || (best && !is_nearer(*q, *best, near))) return;
      if (*q == branch.q || confirmed(task, *q)) best = *q;
    });
    if (best && out.size() < kMostBranches) out.push_back(*best);
  }
  if (out.size() > 0) return BranchStatus::kSolved;
  return found.branches.empty() && !found.held ? BranchStatus::kUnreachable
                                               : BranchStatus::kOutsideLimits;
}

}  // namespace viapoint
