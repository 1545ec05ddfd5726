#include "kinematics/nearly_closed_inverse.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace viapoint {
namespace {

/// A descent that moves a joint farther than this has left its branch [rad].
constexpr double kMostMove = 0.2;
/// Steps of such a descent: the error squares itself with each.
constexpr Descent::Options kPolish{.bounded = false, .iterations = 12, .patience = 4};
constexpr size_t kAllBranches = 8;
/// Descents find a branch to this [rad].
constexpr double kFound = 1e-6;

JointLimits wider(const JointLimits& limits) {
  JointLimits out = limits;
  out.position_min.array() -= kMostMove;
  out.position_max.array() += kMostMove;
  out.coupling.resize(0, limits.joints());
  out.coupling_lower.resize(0);
  out.coupling_upper.resize(0);
  return out;
}

double change_of(const JointVector& a, const JointVector& b) {
  return (a - b).lpNorm<Eigen::Infinity>();
}

}  // namespace

NearlyClosedInverse::NearlyClosedInverse(const ForwardKinematics& forward,
                                         const JointLimits& limits,
                                         std::unique_ptr<const ClosedForm> form)
    : FormInverse(forward, limits, std::move(form)), wider_turns_(forward, wider(limits)) {}

std::unique_ptr<const NearlyClosedInverse> NearlyClosedInverse::make(
    const ForwardKinematics& forward, const JointLimits& limits) {
  auto form = recognise_nearly_closed_form(forward);
  if (!form) return nullptr;
  std::unique_ptr<NearlyClosedInverse> inverse(
      new NearlyClosedInverse(forward, limits, std::move(form)));
  const auto deviation = inverse->deviation();
  if (!deviation) return nullptr;
  inverse->deviation_ = *deviation;
  return inverse;
}

std::optional<PoseError> NearlyClosedInverse::deviation() const {
  // Seeded joints in general position must be found again from the form's branches, nearly always:
  // where the form's elbow does not reach, or the wrist is in line, it may fail.
  constexpr int kTrials = 32;
  constexpr int kEnough = 24;
  PoseError most;
  int again = 0;
  JointVector q(joints());
  for (int trial = 1; trial <= kTrials; ++trial) {
    for (int i = 0; i < joints(); ++i) q[i] = 3.0 * std::sin(1.7 * trial + 2.3 * i * trial);
    const InverseTask task(forward_.pose(q));
    ClosedSolutions found;
    form_->solve(task, q, found);
    bool here = false;
    for (const ClosedBranch& branch : found.branches) {
      const PoseError off = error(task, branch.q);
      most.position = std::max(most.position, off.position);
      most.angle = std::max(most.angle, off.angle);
      const auto end = polished(task, branch.q);
      here = here || (end && change_of(turns_.unlimited(*end, q), q) < 1e-6);
    }
    again += here ? 1 : 0;
  }
  if (again < kEnough) return std::nullopt;
  return most;
}

std::string NearlyClosedInverse::family() const {
  char size[96];
  std::snprintf(size, sizeof size, "%.3g m and %.3g rad", deviation_.position, deviation_.angle);
  return form_->family() + ", out of true by up to " + size +
         ": its closed form, then descents on the arm as it is";
}

std::optional<JointVector> NearlyClosedInverse::polished(const InverseTask& task,
                                                         const JointVector& start) const {
  const Descent::End end = numerical_.descent().run(task, start, kPolish);
  if (!end.error.within(kPoseTolerance) || change_of(end.q, start) > kMostMove) {
    return std::nullopt;
  }
  return end.q;
}

std::optional<JointVector> NearlyClosedInverse::polished_near(const InverseTask& task,
                                                              const JointVector& start,
                                                              const JointVector& reference) const {
  auto q = polished(task, start);
  bool moved = false;
  if (q && !turns_.bring_near(*q, reference, &moved)) q.reset();
  if (q && moved && !confirmed(task, *q)) q.reset();
  return q;
}

template <typename Branches>
bool NearlyClosedInverse::is_among(const JointVector& q, const Branches& branches) const {
  return std::any_of(branches.begin(), branches.end(), [&](const JointVector& other) {
    return change_of(turns_.unlimited(q, other), other) < kFound;
  });
}

JointVector NearlyClosedInverse::near(const InverseTask& task, const JointVector& reference) const {
  if (!form_->answers(task)) return numerical_.near(task, reference);
  ClosedSolutions found;
  form_->solve(task, reference, found);
  // The nearest starts first, until none can be as near as what is found.
  struct Start {
    double change = 0.0;
    const ClosedBranch* branch = nullptr;
  };
  std::array<Start, kMostBranches> starts;
  size_t count = 0;
  for (ClosedBranch& branch : found.branches) {
    if (!wider_turns_.bring_near(branch.q, reference, nullptr)) continue;
    starts[count++] = {change_of(branch.q, reference), &branch};
  }
  std::sort(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Start& a, const Start& b) { return a.change < b.change; });
  std::optional<JointVector> best;
  const auto take = [&](const std::optional<JointVector>& q) {
    if (q && (!best || is_nearer(*q, *best, reference))) best = q;
  };
  for (size_t i = 0; i < count; ++i) {
    if (best && starts[i].change > change_of(*best, reference) + kMostMove) break;
    take(polished_near(task, starts[i].branch->q, reference));
  }
  // Close to a singular pose the true arm may have lost the branch that is wanted.
  take(numerical_.follow(task, reference));
  return best ? *best : numerical_.near(task, reference);
}

std::vector<JointVector> NearlyClosedInverse::all(const InverseTask& task,
                                                  const JointVector& reference) const {
  if (!form_->answers(task)) return numerical_.all(task, reference);
  ClosedSolutions found;
  form_->solve(task, reference, found);
  std::vector<JointVector> branches;
  const auto add = [&](const JointVector& q) {
    if (!is_among(q, branches)) branches.push_back(q);
  };
  for (const ClosedBranch& branch : found.branches) {
    if (const auto q = polished(task, branch.q)) add(*q);
  }
  if (branches.size() < kAllBranches) {
    for (const JointVector& q : numerical_.find_all(task, reference)) add(q);
  }
  std::vector<JointVector> solutions;
  for (const JointVector& branch : branches) add_turns(task, branch, reference, solutions);
  if (solutions.empty()) return numerical_.all(task, reference);
  sort_nearest_first(solutions, reference);
  return solutions;
}

JointVector NearlyClosedInverse::near_unlimited(const InverseTask& task,
                                                const JointVector& reference) const {
  ClosedSolutions found;
  if (form_->answers(task)) form_->solve(task, reference, found);
  std::optional<JointVector> best;
  for (const ClosedBranch& branch : found.branches) {
    const auto end = polished(task, branch.q);
    if (!end) continue;
    const JointVector q = turns_.unlimited(*end, reference);
    if (!best || is_nearer(q, *best, reference)) best = q;
  }
  return best ? *best : numerical_.near_unlimited(task, reference);
}

BranchStatus NearlyClosedInverse::branches_near(const InverseTask& task, const JointVector& near,
                                                BranchSet& out) const noexcept {
  ClosedSolutions found;
  form_->solve(task, near, found);
  bool any = false;
  const auto add = [&](const JointVector& start) {
    auto q = polished(task, start);
    any = any || q.has_value();
    bool moved = false;
    if (!q || !turns_.bring_near(*q, near, &moved) || (moved && !confirmed(task, *q))) return;
    if (!is_among(*q, out) && out.size() < kMostBranches) out.push_back(*q);
  };
  for (const ClosedBranch& branch : found.branches) add(branch.q);
  // Close to a singular pose the true arm may have lost the branch that is wanted.
  add(near);
  if (out.size() > 0) return BranchStatus::kSolved;
  return any ? BranchStatus::kOutsideLimits : BranchStatus::kUnreachable;
}

}  // namespace viapoint
