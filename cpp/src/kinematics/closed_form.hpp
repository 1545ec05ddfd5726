/// @file
/// What the closed forms of six-axis arms have in common.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

/// One family of solutions, whole turns left aside.
struct ClosedBranch {
  JointVector q;
  /// At a wrist singularity of a spherical wrist only q4 + sign · q6 is determined.
  bool wrist_free = false;
  double wrist_sum = 0.0;   ///< q4 + sign · q6 [rad]
  double wrist_sign = 1.0;  ///< +1 or -1
};

/// What the closed form finds for one pose.
struct ClosedSolutions {
  std::vector<ClosedBranch> branches;
  double out_of_reach = 0.0;  ///< how far the wrist is out of reach [m]; 0 when it is not
  /// A joint was held at a singular pose, and another value of it might do better.
  bool held = false;
};

/// Nearness to each of the three singularities.
struct ArmSingularities {
  double shoulder = 0.0;  ///< wrist to the plane of axis 1 parallel to axis 2 [m]
  double elbow = 0.0;     ///< elbow from stretched or folded [rad]
  double wrist = 0.0;     ///< wrist from the alignment of its axes [rad]
  double length = 0.0;    ///< upper arm + forearm [m], to compare metres with radians
};

/// The geometry of one kind of arm, read off its chain at q = 0. Immutable. Threads: any.
class ClosedForm {
 public:
  virtual ~ClosedForm() = default;
  [[nodiscard]] virtual std::string family() const = 0;
  /// Every branch (up to eight); where a joint is free it takes its value in `held`.
  [[nodiscard]] virtual ClosedSolutions solve(const Pose& pose_base_tool,
                                              const JointVector& held) const = 0;
  [[nodiscard]] virtual ArmSingularities singularities(const JointVector& q) const = 0;
};

/// The closed form for this chain, or nothing.
[[nodiscard]] std::unique_ptr<const ClosedForm> recognise_closed_form(
    const ForwardKinematics& forward);

// What the solvers share.

/// How exactly axes must be parallel, square or concurrent for a closed form to be used.
inline constexpr double kExactAxes = 1e-9;
/// A wrist beyond the boundary by no more than this is taken to be on it [m]; the forward
/// kinematics still has to confirm the answer.
inline constexpr double kBoundary = 1e-9;
/// Below this sine of the wrist angle two joints turn about one line [rad].
inline constexpr double kWristSine = 2e-10;
/// Below this distance a direction is not determined [m].
inline constexpr double kOnAxis = 1e-10;

/// The elbow of a planar arm with links a and b that spans `reach`, in [0, π]; 0 is stretched.
struct Elbow {
  bool solved = false;
  double angle = 0.0;         ///< [rad]
  double out_of_reach = 0.0;  ///< [m], when not solved
};
[[nodiscard]] Elbow bend_elbow(double a, double b, double reach);

/// The shoulder's own part: a point at `side` along axis 2 from axis 1 reaches (x, y) in two ways.
struct ShoulderBranch {
  double forward = 0.0;  ///< of the point, in the arm's plane, before joint 1 turns [m]
  double q1 = 0.0;       ///< [rad]
};
/// @param out_of_reach set when there is none [m]
[[nodiscard]] std::vector<ShoulderBranch> turn_shoulder(double x, double y, double side,
                                                        double held, double& out_of_reach);

/// Point of line a nearest to line b; nothing when they are parallel.
[[nodiscard]] std::optional<Eigen::Vector3d> nearest_point(const Eigen::Vector3d& origin_a,
                                                           const Eigen::Vector3d& axis_a,
                                                           const Eigen::Vector3d& origin_b,
                                                           const Eigen::Vector3d& axis_b);

/// Base to frame S: origin on axis 1 at the height of axis 2, z along axis 1, y along axis 2.
[[nodiscard]] Pose shoulder_frame(const ChainFrames& zero);

/// Rotation about y and z by `angle`.
[[nodiscard]] Eigen::Matrix3d about_y(double angle);
[[nodiscard]] Eigen::Matrix3d about_z(double angle);

/// `angle` from the nearest multiple of π, in [0, π/2].
[[nodiscard]] double from_half_turns(double angle);

}  // namespace viapoint
