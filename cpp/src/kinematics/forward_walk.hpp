/// @file
#pragma once

#include <array>
#include <cmath>

#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

/// A chain as frames whose z axes are the joints', each seen from the one before.
class WalkedChain {
 public:
  explicit WalkedChain(const ForwardKinematics& forward);

  [[nodiscard]] int joints() const { return joints_; }
  [[nodiscard]] JointType type(int joint) const { return steps_[static_cast<size_t>(joint)].type; }
  /// Takes a frame, base to the joint before, on through `joint` at q. Real-time: safe.
  void advance(int joint, double q, Eigen::Matrix3d& rotation, Eigen::Vector3d& origin) const {
    const Step& step = steps_[static_cast<size_t>(joint)];
    origin += rotation * step.offset;
    rotation = (rotation * step.rotation).eval();
    if (step.type == JointType::kPrismatic) {
      origin += q * rotation.col(2);
      return;
    }
    const double c = std::cos(q);
    const double s = std::sin(q);
    const Eigen::Vector3d x = rotation.col(0);
    rotation.col(0) = c * x + s * rotation.col(1);
    rotation.col(1) = c * rotation.col(1) - s * x;
  }
  [[nodiscard]] const Eigen::Matrix3d& tool_rotation() const { return tool_rotation_; }
  [[nodiscard]] const Eigen::Vector3d& tool_offset() const { return tool_offset_; }

 private:
  struct Step {
    JointType type = JointType::kRevolute;
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< [m]
  };
  int joints_ = 0;
  std::array<Step, kMaxJoints> steps_;
  Eigen::Matrix3d tool_rotation_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d tool_offset_ = Eigen::Vector3d::Zero();  ///< [m]
};

/// Poses of many joint vectors, one after the other: joints that are as in the one before, from the
/// base on, are not walked again, as the branches of a pose share theirs. Real-time: safe. Threads:
/// one each.
class ForwardWalk {
 public:
  /// @pre `chain` outlives the walk
  explicit ForwardWalk(const WalkedChain& chain) : chain_(chain) {}
  /// pose_base_tool; differs from that of the forward kinematics by rounding only.
  [[nodiscard]] Pose pose(const JointVector& q);

 private:
  const WalkedChain& chain_;
  int known_ = 0;  ///< frames that belong to last_
  JointVector last_;
  std::array<Eigen::Matrix3d, kMaxJoints> rotation_;  ///< after each joint
  std::array<Eigen::Vector3d, kMaxJoints> origin_;    ///< [m]
};

}  // namespace viapoint
