#include "kinematics/branch_inverse.hpp"

namespace viapoint {
namespace {

/// Nearer than this to its singularity a side is neither one nor the other: the share that the
/// rounding of a pose leaves of a joint there [rad, or m over the arm's length].
constexpr double kOnSingularity = 1e-7;

int side_of(const std::optional<double>& distance, double unit) {
  if (!distance || std::abs(*distance) < kOnSingularity * unit) return 0;
  return *distance > 0.0 ? 1 : -1;
}

}  // namespace

BranchInverse::BranchInverse(const ForwardKinematics& forward, const JointLimits& limits)
    : LimitedInverse(forward, limits),
      walked_(forward),
      numerical_(forward, limits, "where the closed form does not answer") {}

Configuration BranchInverse::configuration_of(const ArmSides& sides) {
  Configuration out;
  out.shoulder = side_of(sides.shoulder, sides.length);
  out.elbow = side_of(sides.elbow, 1.0);
  out.wrist = side_of(sides.wrist, 1.0);
  return out;
}

void BranchInverse::keep_confirmed(const InverseTask& task, ClosedSolutions& found) const {
  if (found.confirmed && !found.meeting) return;
  const ClosedBranch* first = found.branches.begin();
  // Branches meet at singular poses: what is found twice is kept once. What is kept stands before
  // the one looked at.
  int kept = 0;
  ForwardWalk walk(walked_);
  found.branches.keep_if([&](const ClosedBranch& branch) {
    if (!found.confirmed && !task.error_of(walk.pose(branch.q)).within(kPoseTolerance))
      return false;
    for (int i = 0; i < kept; ++i) {
      if (are_same(branch.q, first[i].q)) return false;
    }
    ++kept;
    return true;
  });
}

bool BranchInverse::are_same(const JointVector& a, const JointVector& b) const {
  for (int i = 0; i < joints(); ++i) {
    double apart = std::abs(a[i] - b[i]);
    if (apart < kSame) continue;
    if (forward_.type(i) == JointType::kPrismatic) return false;
    if (apart < 2.0 * kPi - kSame) return false;
    if (std::abs(std::remainder(apart, 2.0 * kPi)) >= kSame) return false;
  }
  return true;
}

void BranchInverse::gather(const InverseTask& task, const JointVector& near, ClosedSolutions& found,
                           BranchSet& out) const {
  for (ClosedBranch& branch : found.branches) {
    if (!branch.wrist_free) {
      bool moved = false;
      if (!turns_.bring_near(branch.q, near, &moved)) continue;
      if (!moved || confirmed(task, branch.q)) out.push_back(branch.q);
      continue;
    }
    std::optional<JointVector> best;
    each_share(branch, near, [&](const JointVector& candidate) {
      bool moved = true;
      const auto q = turns_.nearest(candidate, near, &moved);
      if (!q || (best && !is_nearer(*q, *best, near))) return;
      if (!moved || confirmed(task, *q)) best = *q;
    });
    if (best && out.size() < kMostBranches) out.push_back(*best);
  }
}

std::optional<JointVector> BranchInverse::nearest(const InverseTask& task,
                                                  const JointVector& candidate,
                                                  const JointVector& reference) const {
  bool moved = false;
  std::optional<JointVector> q = turns_.nearest(candidate, reference, &moved);
  if (!q || !moved || confirmed(task, *q)) return q;
  // A joint was set on its limit and misses the pose there: another turn may not need that.
  q.reset();
  for (const JointVector& turn : turns_.all(candidate, reference)) {
    if ((!q || is_nearer(turn, *q, reference)) && confirmed(task, turn)) q = turn;
  }
  return q;
}

}  // namespace viapoint
