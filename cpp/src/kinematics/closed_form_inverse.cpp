#include "kinematics/closed_form_inverse.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viapoint {
namespace {

/// The search may still find an answer, or can say what is missing: a joint was held badly, or the
/// wrist is within reach and the forward kinematics denies every branch.
bool undecided(const ClosedSolutions& found) {
  return found.held || (found.branches.empty() && found.out_of_reach == 0.0);
}

}  // namespace

ClosedFormInverse::ClosedFormInverse(const ForwardKinematics& forward, const JointLimits& limits,
                                     std::unique_ptr<const ClosedForm> form)
    : FormInverse(forward, limits, std::move(form)) {
  trusted_ = models_exactly();
}

bool ClosedFormInverse::models_exactly() const {
  // The axes were compared to kExactAxes. What an arm's pose may differ by from its form's goes
  // like the sines of the joints, so that seeded joints show its size; the form leaves ten times
  // this much (kFormTolerance).
  constexpr double kExact = 1e-11;
  constexpr int kTrials = 24;
  JointVector q(joints());
  for (int trial = 1; trial <= kTrials; ++trial) {
    for (int i = 0; i < joints(); ++i) q[i] = 3.0 * std::sin(1.7 * trial + 2.3 * i * trial);
    const InverseTask task(forward_.pose(q));
    ClosedSolutions found;
    form_->solve(task, q, found);
    if (!found.confirmed || found.branches.empty()) return false;
    for (const ClosedBranch& branch : found.branches) {
      if (!error(task, branch.q).within(kExact)) return false;
    }
  }
  return true;
}

void ClosedFormInverse::branches(const InverseTask& task, const JointVector& held,
                                 ClosedSolutions& found) const {
  form_->solve(task, held, found);
  found.confirmed = found.confirmed && trusted_;
  keep_confirmed(task, found);
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
  sort_nearest_first(solutions, reference);
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

BranchStatus ClosedFormInverse::branches_near(const InverseTask& task, const JointVector& near,
                                              BranchSet& out) const noexcept {
  ClosedSolutions found;
  branches(task, near, found);
  gather(task, near, found, out);
  if (out.size() > 0) return BranchStatus::kSolved;
  return found.branches.empty() && !found.held ? BranchStatus::kUnreachable
                                               : BranchStatus::kOutsideLimits;
}

}  // namespace viapoint
