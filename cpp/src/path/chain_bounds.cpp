#include "path/chain_bounds.hpp"

#include <algorithm>

namespace viapoint {

JointSuprema joint_suprema(const JointPiece& piece, const PathPoint& at, double middle,
                           double half) {
  const double rate = 1.0 / piece.length;
  const double rate4 = rate * rate * rate * rate;
  const double u = middle * rate;
  const JointVector fourth =
      (24.0 * piece.coefficients.row(4) + 120.0 * u * piece.coefficients.row(5)).transpose() *
      rate4;
  const JointVector fifth = 120.0 * rate4 * rate * piece.coefficients.row(5).transpose();
  JointSuprema sup;
  sup.q3 = at.q3.cwiseAbs() + half * (fourth.cwiseAbs() + 0.5 * half * fifth.cwiseAbs());
  sup.q2 = at.q2.cwiseAbs() + half * sup.q3;
  sup.q1 = at.q1.cwiseAbs() + half * sup.q2;
  return sup;
}

JointSuprema suprema_over(const JointPath& path, double s0, double s1) {
  JointSuprema sup;
  const size_t last = path.piece_at(s1);
  for (size_t k = path.piece_at(s0); k <= last; ++k) {
    const JointPiece& piece = path.pieces()[k];
    const double from = std::clamp(s0 - path.start_of(k), 0.0, piece.length);
    const double to = std::clamp(s1 - path.start_of(k), 0.0, piece.length);
    const double middle = 0.5 * (from + to);
    const JointSuprema here = joint_suprema(piece, piece.at(middle), middle, 0.5 * (to - from));
    if (sup.q1.size() == 0) {
      sup = here;
    } else {
      sup.q1 = sup.q1.cwiseMax(here.q1);
      sup.q2 = sup.q2.cwiseMax(here.q2);
      sup.q3 = sup.q3.cwiseMax(here.q3);
    }
  }
  return sup;
}

double last_start_within(const JointPath& path, double s0, double s1) {
  size_t k = path.piece_at(s1);
  // s1 may be a knot itself: then the piece begins there.
  if (path.start_of(k) >= s1 && k > 0) --k;
  const double start = path.start_of(k);
  return start > s0 && start < s1 ? start : s1;
}

JointVector reach_over(const ForwardKinematics& arm, const JointPiece& piece) {
  // |q| <= Σ_k |coefficient of u^k| for u in [0, 1]; only prismatic travel matters.
  const JointVector travel = piece.coefficients.cwiseAbs().colwise().sum().transpose();
  return arm.reach_bound(travel);
}

double position_third_bound(const ForwardKinematics& arm, const JointVector& reach,
                            const JointSuprema& sup) {
  double bound = 0.0;
  double below1 = 0.0;  // Σ |q'| over the revolute joints nearer the base
  double below2 = 0.0;  // Σ |q''|, likewise
  for (int i = 0; i < arm.joints(); ++i) {
    const double a1 = sup.q1[i];
    const double a2 = sup.q2[i];
    const double mixed = a2 * below1 + a1 * below2;
    if (arm.type(i) == JointType::kPrismatic) {
      bound += 3.0 * a1 * below1 * below1 + 3.0 * mixed + sup.q3[i];
      continue;
    }
    const double upto1 = below1 + a1;
    const double cubes = upto1 * upto1 * upto1 - below1 * below1 * below1;
    bound += reach[i] * (cubes + 3.0 * (mixed + a1 * a2) + sup.q3[i]);
    below1 = upto1;
    below2 += a2;
  }
  return bound;
}

double rotation_second_bound(const ForwardKinematics& arm, const JointSuprema& sup) {
  double bound = 0.0;
  double below1 = 0.0;
  double below2 = 0.0;
  for (int i = 0; i < arm.joints(); ++i) {
    if (arm.type(i) == JointType::kPrismatic) continue;
    bound += sup.q3[i] + 2.0 * sup.q2[i] * below1 + sup.q1[i] * (below2 + below1 * below1);
    below1 += sup.q1[i];
    below2 += sup.q2[i];
  }
  return bound;
}

}  // namespace viapoint
