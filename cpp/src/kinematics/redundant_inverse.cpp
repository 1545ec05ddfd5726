#include "kinematics/redundant_inverse.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "viapoint/core/scalar_minimum.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

constexpr double kNone = 1e300;
constexpr double kNearEnough = 0.35;  ///< a change of every joint below this is near [rad]
/// Parameters looked at, first few, then more where these found nothing.
constexpr std::array kScans{14, 48};
constexpr int kScan = 64;        ///< where the whole range counts
constexpr int kSweep = 96;       ///< where every configuration is wanted
constexpr int kFineScan = 1024;  ///< before a pose is given up
constexpr int kRefinements = 5;
/// What costs so much more than the best [rad²] does not guide its refinement.
constexpr double kDearer = 0.5;
constexpr double kResolution = 1e-4;  ///< of the stretch refined
constexpr int kHalvings = 40;
/// Within this share of its range from a limit a joint is crowded, and at the limit that counts as
/// much as a move of half a radian.
constexpr double kCrowded = 0.05;
constexpr double kCrowdingCost = 0.25;

}  // namespace

RedundantInverse::RedundantInverse(const ForwardKinematics& forward, const JointLimits& limits,
                                   std::unique_ptr<const RedundantForm> form)
    : FormInverse(forward, limits, std::move(form)), sweep_(forward, limits) {}

double RedundantInverse::redundancy_of(const JointVector& q) const {
  require_joints(q, joints(), "q");
  return form_->parameter_of(q);
}

std::vector<JointVector> RedundantInverse::solve_all_at(const Pose& pose_base_tool,
                                                        double redundancy,
                                                        const JointVector& reference) const {
  require_pose(pose_base_tool);
  require_joints(reference, joints(), "reference");
  const InverseTask task(pose_base_tool);
  ClosedSolutions found;
  form_->solve(pose_base_tool, redundancy, reference, found);
  keep_confirmed(task, found);
  if (found.branches.empty()) {
    refuse_unreachable("the pose with this " + form_->parameter(), found.out_of_reach);
  }
  std::vector<JointVector> solutions;
  std::vector<JointVector> refused;
  for (const ClosedBranch& branch : found.branches) {
    each_share(branch, reference, [&](const JointVector& candidate) {
      if (!add_turns(task, candidate, reference, solutions)) refused.push_back(candidate);
    });
  }
  if (solutions.empty()) refuse_outside_limits(forward_, turns_, refused);
  sort_nearest_first(solutions, reference);
  return solutions;
}

BranchStatus RedundantInverse::branches_near(const InverseTask& task, const JointVector& near,
                                             BranchSet& out) const noexcept {
  ClosedSolutions found;
  form_->solve(task.goal, form_->parameter_of(near), near, found);
  keep_confirmed(task, found);
  gather(task, near, found, out);
  if (out.size() > 0) return BranchStatus::kSolved;
  return found.branches.empty() ? BranchStatus::kUnreachable : BranchStatus::kOutsideLimits;
}

double RedundantInverse::margin(const JointVector& q) const {
  double least = 0.5;
  for (int i = 0; i < q.size(); ++i) {
    const double width = limits_.position_max[i] - limits_.position_min[i];
    if (!std::isfinite(width)) continue;
    const double room = std::min(q[i] - limits_.position_min[i], limits_.position_max[i] - q[i]);
    least = std::min(least, room / width);
  }
  return least;
}

double RedundantInverse::crowding(const JointVector& q) const {
  const double share = std::max(0.0, 1.0 - margin(q) / kCrowded);
  return kCrowdingCost * share * share;
}

RedundantInverse::Choice RedundantInverse::choose(const InverseTask& task, double parameter,
                                                  const JointVector& reference, double most) const {
  Choice best;
  best.parameter = parameter;
  ClosedSolutions found;
  form_->solve(task.goal, parameter, reference, found, JointSieve(turns_, reference, most));
  for (const ClosedBranch& branch : found.branches) {
    each_share(branch, reference, [&](const JointVector& candidate) {
      JointVector q = candidate;
      if (!turns_.bring_near(q, reference, nullptr)) return;
      const double price = cost(q, reference);
      if (price >= std::min(best.cost, most) || !confirmed(task, q)) return;
      best.q = q;
      best.cost = price;
    });
  }
  return best;
}

RedundantInverse::Choice RedundantInverse::refine(const InverseTask& task, Choice best, double half,
                                                  const JointVector& reference) const {
  // A parameter without a solution counts as infinitely dear.
  const auto [least, most] = form_->range(limits_);
  const double low = std::max(best.parameter - half, least);
  const double high = std::min(best.parameter + half, most);
  const double too_dear = best.cost + kDearer;
  const auto look = [&](double parameter) {
    const Choice found = choose(task, parameter, reference, too_dear);
    if (found.cost < best.cost) best = found;
    return found.cost < kNone ? found.cost : std::numeric_limits<double>::infinity();
  };
  (void)refined_minimum(low, high, {best.parameter, best.cost}, kResolution * half, kRefinements,
                        look);
  return best;
}

RedundantInverse::Choice RedundantInverse::scan(const InverseTask& task, int count,
                                                const JointVector& reference) const {
  const auto [low, high] = form_->range(limits_);
  const double step = (high - low) / count;
  // From where the reference is outwards: the sooner a cheap one is found, the more of the others
  // need not be solved.
  const double from = step > 0.0 ? (form_->parameter_of(reference) - low) / step : 0.0;
  const double middle = std::clamp(from, 0.0, 1.0 * count);
  const int last = high - low < 2.0 * kPi ? count : count - 1;  // of a whole turn both ends are one
  int below = static_cast<int>(middle);
  int above = below + 1;
  Choice best;
  while (below >= 0 || above <= last) {
    const bool down = above > last || (below >= 0 && middle - below < above - middle);
    Choice found = choose(task, low + step * (down ? below-- : above++), reference, best.cost);
    if (found.cost < best.cost) best = std::move(found);
  }
  return best.cost < kNone ? refine(task, best, step, reference) : best;
}

JointVector RedundantInverse::near(const InverseTask& task, const JointVector& reference) const {
  if (task.position_only) return numerical_.near(task, reference);
  // Near the reference the least motion is what least squares take from there; the parameter alone
  // is no guide where it hardly moves a joint, or moves some without end (shoulder in line).
  const auto followed = numerical_.follow(task, reference, 2.0 * kNearEnough);
  if (followed && (*followed - reference).lpNorm<Eigen::Infinity>() < kNearEnough) {
    return *followed;
  }
  Choice best;
  if (followed) {
    best.q = *followed;
    best.cost = cost(best.q, reference);
  }
  for (const int count : kScans) {
    const Choice found = scan(task, count, reference);
    if (found.cost < best.cost) best = found;
    if (best.cost < kNone) return best.q;
  }
  // Narrow stretches between those parameters: descents find them sooner than a finer scan.
  if (const auto found = numerical_.find(task, reference)) return *found;
  best = scan(task, kFineScan, reference);
  if (best.cost < kNone) return best.q;
  const double missing = least_missing(task, reference);
  if (missing > kPoseTolerance) refuse_unreachable("the wrist at this pose", missing);
  // The search may know a parameter between those looked at, and says what is wrong.
  return numerical_.near(task, reference);
}

double RedundantInverse::least_missing(const InverseTask& task,
                                       const JointVector& reference) const {
  const auto missing_at = [&](double parameter) {
    ClosedSolutions found;
    form_->solve(task.goal, parameter, reference, found);
    return found.branches.empty() ? found.out_of_reach : 0.0;
  };
  const auto [low, high] = form_->range(limits_);
  double least = kNone;
  double where = low;
  for (int i = 0; i <= kScan; ++i) {
    const double parameter = low + (high - low) * i / kScan;
    const double missing = missing_at(parameter);
    if (missing < least) where = parameter;
    least = std::min(least, missing);
    if (least == 0.0) return 0.0;
  }
  double half = (high - low) / kScan;
  for (int i = 0; i < kHalvings; ++i, half *= 0.5) {
    for (const double parameter : {where - 0.5 * half, where + 0.5 * half}) {
      const double missing = missing_at(parameter);
      if (missing < least) where = parameter;
      least = std::min(least, missing);
    }
  }
  return least;
}

std::vector<JointVector> RedundantInverse::all(const InverseTask& task,
                                               const JointVector& reference) const {
  if (task.position_only) return numerical_.all(task, reference);
  const auto [low, high] = form_->range(limits_);
  const auto solve = [&](double parameter, ClosedSolutions& found) {
    form_->solve(task.goal, parameter, reference, found);
  };
  const auto signs = [](const ArmSides& found) {
    const Configuration side = configuration_of(found);
    return std::array{side.shoulder, side.elbow, side.wrist};
  };
  const auto accept = [&](const JointVector& q) { return confirmed(task, q); };
  std::vector<JointVector> solutions;
  for (const int count : {kSweep, kFineScan}) {
    for (const JointVector& q : sweep_.find(low, high, count, reference, solve, signs, accept)) {
      add_turns(task, q, reference, solutions);
    }
    if (!solutions.empty()) break;
  }
  if (solutions.empty()) {
    const double missing = least_missing(task, reference);
    if (missing > kPoseTolerance) refuse_unreachable("the wrist at this pose", missing);
    return numerical_.all(task, reference);
  }
  sort_nearest_first(solutions, reference);
  return solutions;
}

JointVector RedundantInverse::near_unlimited(const InverseTask& task,
                                             const JointVector& reference) const {
  return numerical_.near_unlimited(task, reference);
}

}  // namespace viapoint
