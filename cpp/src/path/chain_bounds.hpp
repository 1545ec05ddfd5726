/// @file
/// How fast the tool of a serial chain can change its acceleration and its angular acceleration
/// along q(s), from the sizes of q', q'' and q''' alone: the remainder terms of the deviation
/// proof.
///
/// Position. With z_i the axis of joint i, r_i the vector from a point of that axis to the tool
/// point and i1 <= i2 <= … <= ik counted from the base, the partial derivatives of the tool point
/// are nested cross products (the joint nearer the base turns everything outside it):
///   ∂^k p / ∂q_i1 … ∂q_ik = z_i1 × (z_i2 × (… (z_ik × r_ik)))            all revolute.
/// Each cross product with a unit vector cannot lengthen, and ‖z_ik × r_ik‖ is the distance of the
/// tool point from the *outermost* axis concerned, at most R_ik over all q. If the outermost joint
/// is prismatic, its column is the unit vector z_ik in place of z_ik × r_ik, so R_ik = 1, and a
/// second derivative by the same joint is zero. If a joint that is not the outermost is prismatic,
/// the derivative is zero: sliding it moves the outer axis and the tool point alike. With
///   p''' = Σ_ijk p_ijk q'_i q'_j q'_k + 3 Σ_ij p_ij q''_i q'_j + Σ_i p_i q'''_i
/// follows
///   ‖p'''‖ <= Σ_ijk |q'_i||q'_j||q'_k| R_max(i,j,k) + 3 Σ_ij |q''_i||q'_j| R_max(i,j)
///             + Σ_i |q'''_i| R_i,
/// sums over the combinations that are not zero by the above.
///
/// Rotation. w = Σ_i z_i q'_i over the revolute joints, and z_i is turned by the joints below it:
/// z_i' = Σ_{j<i} z_j × z_i q'_j. Differentiating twice, every vector that appears is a nested
/// cross product of unit vectors, so with P_i = Σ_{j<i} |q'_j| and Q_i = Σ_{j<i} |q''_j|
///   ‖w''‖ <= Σ_i |q'''_i| + 2 |q''_i| P_i + |q'_i| Q_i + |q'_i| P_i².
#pragma once

#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint {

/// Suprema over an interval of s of |q'|, |q''| and |q'''|, joint by joint, each (n,).
struct JointSuprema {
  JointVector q1, q2, q3;
};

/// Of a quintic piece over [middle - half, middle + half], from its exact Taylor expansion about
/// the middle. `at` is piece.at(middle). Real-time: safe.
[[nodiscard]] JointSuprema joint_suprema(const JointPiece& piece, const PathPoint& at,
                                         double middle, double half);

/// The same over [s0, s1] of a path, whatever pieces lie there. Real-time: safe.
[[nodiscard]] JointSuprema suprema_over(const JointPath& path, double s0, double s1);

/// The last start of a piece inside (s0, s1); s1 where there is none.
[[nodiscard]] double last_start_within(const JointPath& path, double s0, double s1);

/// Reach bounds R_i of the chain over the joint positions of the piece (n,) [m].
[[nodiscard]] JointVector reach_over(const ForwardKinematics& arm, const JointPiece& piece);

/// Upper bound of ‖p'''‖ of the tool point. @param reach R_i [m], (n,), unused for prismatic joints
[[nodiscard]] double position_third_bound(const ForwardKinematics& arm, const JointVector& reach,
                                          const JointSuprema& sup);
/// Upper bound of ‖w''‖ of the tool's angular rate w by s.
[[nodiscard]] double rotation_second_bound(const ForwardKinematics& arm, const JointSuprema& sup);

}  // namespace viapoint
