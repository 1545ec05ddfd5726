/// @file
/// Turns a tool curve into C² joint pieces whose deviation from it is proven over every interval,
/// not at samples (idea of the midpoint bisection: Taylor 1979; the bound is ours, docs/maths).
#pragma once

#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/core/joint_limits.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/path/task_curve.hpp"

namespace viapoint {

/// Which coordinates of the tool the joints must hold.
enum class Hold {
  kPose,      ///< position and orientation
  kAxis,      ///< position and the direction of the tool's z axis; the spin about it is free
  kPosition,  ///< position; the orientation is free (arms that cannot hold it)
  kWrist,     ///< position by the first three joints; the others go straight to `wrist_goal`
};

struct JointGuide;

struct InsertionOptions {
  double position_tolerance = 5e-5;  ///< [m]
  double angle_tolerance =
      1.7453292519943296e-4;  ///< [rad]; of the rotation, or of the axis for kAxis
  Hold hold = Hold::kPose;
  JointVector wrist_goal;  ///< (n,), entries from 3 on are used; Hold::kWrist only
  /// Which joints are taken where there is one more than coordinates held (path/joint_guide.hpp),
  /// from `start` on; null: those of the least rate. Borrowed.
  const JointGuide* guide = nullptr;
};

struct Insertion {
  std::vector<JointPiece> pieces;   ///< C², kind kCurve, s as the curve's; move left at 0
  std::vector<JointVector> knots;   ///< pieces.size() + 1
  double position_deviation = 0.0;  ///< proven [m]
  double angle_deviation = 0.0;     ///< proven [rad], of what is held; 0 where nothing is
};

/// Follows the curve continuously from `start` (which must be on it): knots by Newton's method from
/// extrapolated joints, q' and q'' exact at each from J q' = x' and J q'' = x'' − J' q', quintics
/// between, as long as the tolerances allow. A piece counts only when its deviation is proven over
/// all of it, so the joints cannot change branch between knots.
/// Real-time: not. Threads: any.
/// The joint position limits and coupled limits hold over the whole of every piece (proven on its
/// polynomial).
/// @throws MotionError with `share` of the curve and, where it applies, joint, value, limit:
///   kJointLimit, kCouplingLimit (first place where a limit is left), kSingular (the joints cannot
///   follow: rate beyond all bounds), kUnreachable (the curve leaves the workspace, or leads so far
///   away that it must: then value is the goal's distance, limit the reach), kUncontrolled
///   (the arm has too few joints to hold the coordinates, and names them, or joints that together
///   never move all of them), kZeroLength, kDiscontinuous (start is not on the curve), kBadArgument
///   (also for a curve that takes more than 20000 pieces, or far more looking for their proof than
///   pieces take: the work is counted)
/// For a limit, `value` is the farthest that the joint would go along the rest of the curve,
/// followed until the limit is passed by 2π [rad, m], or for 1000 pieces more. Where the tool
/// hardly tells how joints turn (a singular wrist), a piece counts only when no free revolute joint
/// sweeps much more over it than it changes, nor more than 1 rad.
[[nodiscard]] Insertion insert_curve(const ForwardKinematics& arm, const JointLimits& limits,
                                     const TaskCurve& curve, const JointVector& start,
                                     const InsertionOptions& options);

/// Largest distances of the tool from a curve.
struct Deviation {
  double position = 0.0;  ///< [m]
  double angle = 0.0;     ///< [rad]
};

/// Upper bounds over the whole piece of the tool's distance from the curve between s0 and
/// s0 + piece.length [m], and of the angle to its rotation [rad]. Proven: Taylor expansion about
/// the middle of subintervals with a bounded remainder: with e(s) = fk(q(s)) − p(s) and the
/// subinterval |s − m| <= δ,
///   ‖e(s)‖ <= max_{|t|<=δ} ‖e(m) + e'(m) t + e''(m) t²/2‖ + δ³/6 (sup‖fk'''‖ + sup‖p'''‖),
/// where e, e' and e'' are exact (J and J' on q' and q'') and the suprema come from those of |q'|,
/// |q''|, |q'''| and the reach of the chain alone; likewise for the angle. Subintervals are halved
/// until the bound is within the resolution of a deviation that is reached.
/// @param s0 where on the curve the piece starts
/// @param resolution_m, resolution_rad > 0: how much above the true maximum the bounds may lie
/// Real-time: not. Threads: any.
[[nodiscard]] Deviation bound_deviation(const ForwardKinematics& arm, const JointPiece& piece,
                                        const TaskCurve& curve, double s0, double resolution_m,
                                        double resolution_rad);

/// Knots between which the joints go straight (Taylor 1979), for study and comparison.
struct TaylorKnots {
  std::vector<double> s;           ///< where on the curve, first 0, last its length
  std::vector<JointVector> knots;  ///< as many
  Deviation at_midpoints;          ///< the largest found where the method looks: no bound
};

/// Bounded deviation joint paths (Taylor 1979): where the tool at the joint midpoint of two knots
/// is farther than a tolerance from the curve's midpoint, a knot is put there; both halves again.
/// That is a test, not a proof: bound_deviation of JointPiece::line between the knots tells the
/// truth.
/// @param start, goal joints at both ends of the curve, on one branch
/// @throws MotionError kBranchChange (the bisection does not end: start and goal are on different
///   branches), kSingular (no joints found at a midpoint), both with share; kZeroLength,
///   kBadArgument
[[nodiscard]] TaylorKnots taylor_insertion(const ForwardKinematics& arm, const TaskCurve& curve,
                                           const JointVector& start, const JointVector& goal,
                                           double position_tolerance, double angle_tolerance);

}  // namespace viapoint
