/// @file
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/pose.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/kinematics/robot_description.hpp"

namespace viapoint {

class InverseKinematics;

/// Nearer than this to a shoulder (share of the arm's length), elbow or wrist singularity [rad], a
/// spherical-wrist arm is called near it: about 5°.
inline constexpr double kNearSingular = 0.0873;
/// The same for general arms: the smallest singular value, position rows over the arm's reach.
inline constexpr double kNearSingularValue = 0.02;

/// How near the arm is to losing a direction of motion.
struct Singularity {
  std::string name;       ///< "none", "shoulder", "elbow", "wrist" or "boundary" (general arms)
  double distance = 0.0;  ///< to the nearest: elbow and wrist [rad], shoulder [m]; smallest
                          ///< singular value of the scaled Jacobian for general arms
  double manipulability = 0.0;  ///< √det(J Jᵀ) (Yoshikawa 1985), of the task rows the arm can move
};

/// An arm: chain, limits, forward and inverse kinematics. Immutable and shared by pointer.
/// Real-time: not (use forward()). Threads: any, at once.
class RobotModel {
 public:
  /// @throws MotionError(kBadRobot, kBadLimits)
  [[nodiscard]] static std::shared_ptr<const RobotModel> make(RobotDescription description);
  /// `joints` joints with limits and no kinematics: PTP only.
  [[nodiscard]] static std::shared_ptr<const RobotModel> joint_robot(const JointLimits& limits);
  /// The same arm under other limits.
  [[nodiscard]] std::shared_ptr<const RobotModel> with_limits(const JointLimits& limits) const;
  /// The same arm with another tool in the place of its own. @throws MotionError(kUncontrolled)
  [[nodiscard]] std::shared_ptr<const RobotModel> with_tool(const Pose& pose_flange_tool) const;
  /// The same arm standing elsewhere: from then on every pose of it is told in the frame that
  /// `pose_world_base` is told in. @throws MotionError(kUncontrolled)
  [[nodiscard]] std::shared_ptr<const RobotModel> with_base(const Pose& pose_world_base) const;

  ~RobotModel();
  RobotModel(const RobotModel&) = delete;
  RobotModel& operator=(const RobotModel&) = delete;

  [[nodiscard]] const RobotDescription& description() const { return description_; }
  [[nodiscard]] const std::string& name() const { return description_.name; }
  [[nodiscard]] int joints() const { return description_.limits.joints(); }
  [[nodiscard]] const JointLimits& limits() const { return description_.limits; }
  /// False for joint_robot: then every Cartesian question is refused with kUncontrolled.
  [[nodiscard]] bool has_kinematics() const { return has_kinematics_; }
  /// Hash of chain, limits and tool: two robots with the same fingerprint move alike. Hex.
  [[nodiscard]] const std::string& fingerprint() const { return fingerprint_; }

  /// pose_base_tool at q, through KDL. @throws MotionError(kBadArgument)
  [[nodiscard]] Pose fk(const JointVector& q) const;
  /// Geometric Jacobian at the tool point, base frame, through KDL.
  [[nodiscard]] Jacobian jacobian(const JointVector& q) const;
  /// √det(J Jᵀ) over the task rows the arm can move; position rows alone where these are more than
  /// the joints (a planar arm of two joints: x and y).
  [[nodiscard]] double manipulability(const JointVector& q) const;
  [[nodiscard]] Singularity singularity(const JointVector& q) const;
  /// Our own chain, for loops and for real time; agrees with fk() to rounding (tested).
  [[nodiscard]] const ForwardKinematics& forward() const { return forward_; }
  /// The solver this arm's geometry allows, or the numerical one. @pre has_kinematics()
  [[nodiscard]] const InverseKinematics& inverse() const { return *inverse_; }

 private:
  struct Kdl;
  RobotModel(RobotDescription description, bool has_kinematics);
  /// @throws MotionError(kUncontrolled) without kinematics
  void require_kinematics() const;
  /// @throws MotionError besides kBadArgument on size or NaN
  void require_kinematics(const JointVector& q) const;

  RobotDescription description_;
  bool has_kinematics_;
  std::string fingerprint_;
  ForwardKinematics forward_;
  std::unique_ptr<const Kdl> kdl_;
  std::unique_ptr<const InverseKinematics> inverse_;
};

using RobotPtr = std::shared_ptr<const RobotModel>;

}  // namespace viapoint
