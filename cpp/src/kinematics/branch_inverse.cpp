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
      numerical_(forward, limits, "where the closed form does not answer") {}

Configuration BranchInverse::configuration_of(const ArmSides& sides) {
  Configuration out;
  out.shoulder = side_of(sides.shoulder, sides.length);
  out.elbow = side_of(sides.elbow, 1.0);
  out.wrist = side_of(sides.wrist, 1.0);
  return out;
}

void BranchInverse::keep_confirmed(const InverseTask& task, ClosedSolutions& found) const {
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

std::optional<JointVector> BranchInverse::nearest(const InverseTask& task,
                                                  const JointVector& candidate,
                                                  const JointVector& reference) const {
  std::optional<JointVector> q = turns_.nearest(candidate, reference);
  if (!q || *q == candidate || confirmed(task, *q)) return q;
  // A joint was set on its limit and misses the pose there: another turn may not need that.
  q.reset();
  for (const JointVector& turn : turns_.all(candidate, reference)) {
    if ((!q || is_nearer(turn, *q, reference)) && confirmed(task, turn)) q = turn;
  }
  return q;
}

}  // namespace viapoint
