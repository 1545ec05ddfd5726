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
  kPosition,  ///< position; the orientation is free (arms that cannot hold it)
  kWrist,     ///< position by the first three joints; the others go straight to `wrist_goal`
};

struct InsertionOptions {
  double position_tolerance = 5e-5;                ///< [m]
  double angle_tolerance = 1.7453292519943296e-4;  ///< [rad]; unused unless Hold::kPose
  Hold hold = Hold::kPose;
  JointVector wrist_goal;  ///< (n,), entries from 3 on are used; Hold::kWrist only
};

struct Insertion {
  std::vector<JointPiece> pieces;   ///< C², kind kCurve, s as the curve's; move left at 0
  std::vector<JointVector> knots;   ///< pieces.size() + 1
  double position_deviation = 0.0;  ///< proven [m]
  double angle_deviation = 0.0;     ///< proven [rad]
};

/// Follows the curve continuously from `start` (which must be on it).
/// The joint position limits and coupled limits hold over the whole of every piece (proven on its
/// polynomial).
/// @throws MotionError with `share` of the curve and, where it applies, joint, value, limit:
///   kJointLimit, kCouplingLimit (first place where a limit is left), kSingular (the joints cannot
///   follow: rate beyond all bounds), kUnreachable (the curve leaves the workspace), kUncontrolled
///   (the arm has too few joints to hold the coordinates; names them)
[[nodiscard]] Insertion insert_curve(const ForwardKinematics& arm, const JointLimits& limits,
                                     const TaskCurve& curve, const JointVector& start,
                                     const InsertionOptions& options);

/// Upper bounds over the whole piece of the tool's distance from the curve between s0 and
/// s0 + piece.length [m], and of the angle to its rotation [rad]. Proven: Taylor expansion about
/// the middle of subintervals with a bounded remainder.
struct Deviation {
  double position = 0.0;
  double angle = 0.0;
};
[[nodiscard]] Deviation bound_deviation(const ForwardKinematics& arm, const JointPiece& piece,
                                        const TaskCurve& curve, double s0, double resolution_m,
                                        double resolution_rad);

}  // namespace viapoint
