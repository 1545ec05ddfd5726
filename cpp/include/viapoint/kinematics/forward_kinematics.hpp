/// @file
/// Forward kinematics without a heap: the serial chain as fixed transforms between joints that turn
/// or slide about one axis each. The one kinematics header that real-time code includes.
#pragma once

#include <array>
#include <span>

#include "viapoint/core/joint_vector.hpp"
#include "viapoint/core/pose.hpp"

namespace viapoint {

enum class JointType { kRevolute, kPrismatic };

/// One joint of a serial chain: go by `before` from the previous joint's frame, then turn about or
/// slide along `axis` (a unit vector in that new frame).
struct ChainJoint {
  JointType type = JointType::kRevolute;
  Pose before = Pose::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
};

/// What one walk along the chain finds, all in the base frame.
struct ChainFrames {
  std::array<Eigen::Vector3d, kMaxJoints> axis;    ///< unit axis of each joint
  std::array<Eigen::Vector3d, kMaxJoints> origin;  ///< a point on each axis [m]
  Pose pose_base_tool = Pose::Identity();
};

/// A serial chain of at most kMaxJoints joints. Immutable; every method is const, allocation-free
/// and O(n). Real-time: safe. Threads: any.
class ForwardKinematics {
 public:
  ForwardKinematics() = default;
  /// @param joints chain from the base; @param tool pose of the tool in the last joint's frame
  ForwardKinematics(std::span<const ChainJoint> joints, const Pose& tool);

  [[nodiscard]] int joints() const { return joints_; }
  [[nodiscard]] JointType type(int joint) const { return chain_[static_cast<size_t>(joint)].type; }

  /// Axes, origins and tool pose at q [rad or m].
  [[nodiscard]] ChainFrames frames(const JointVector& q) const;
  [[nodiscard]] Pose pose(const JointVector& q) const;
  /// Geometric Jacobian at the tool point, base frame.
  [[nodiscard]] Jacobian jacobian(const ChainFrames& frames) const;
  /// Time derivative of the geometric Jacobian for joint rates qd (Hourtash 2005 for the
  /// structure).
  [[nodiscard]] Jacobian jacobian_rate(const ChainFrames& frames, const JointVector& qd) const;
  /// An upper bound over *all* q of the distance from joint i's axis to the tool point [m]:
  /// R_max(i) of the deviation bounds. Prismatic travel enters by `travel` (largest |q_i| [m] a
  /// joint, ignored for revolute ones).
  [[nodiscard]] JointVector reach_bound(const JointVector& travel) const;

 private:
  int joints_ = 0;
  std::array<ChainJoint, kMaxJoints> chain_{};
  Pose tool_ = Pose::Identity();
};

}  // namespace viapoint
