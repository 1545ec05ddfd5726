#include "kinematics/forward_walk.hpp"

namespace viapoint {

WalkedChain::WalkedChain(const ForwardKinematics& forward) : joints_(forward.joints()) {
  const ChainFrames zero = forward.frames(JointVector::Zero(joints_));
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (int i = 0; i < joints_; ++i) {
    const auto k = static_cast<size_t>(i);
    Eigen::Matrix3d next;
    next.col(2) = zero.axis[k];
    next.col(0) = zero.axis[k].unitOrthogonal();
    next.col(1) = next.col(2).cross(next.col(0));
    steps_[k].type = forward.type(i);
    steps_[k].rotation = rotation.transpose() * next;
    steps_[k].offset = rotation.transpose() * (zero.origin[k] - origin);
    rotation = next;
    origin = zero.origin[k];
  }
  tool_rotation_ = rotation.transpose() * zero.pose_base_tool.linear();
  tool_offset_ = rotation.transpose() * (zero.pose_base_tool.translation() - origin);
}

Pose ForwardWalk::pose(const JointVector& q) {
  int from = 0;
  while (from < known_ && q[from] == last_[from]) ++from;
  for (int i = from; i < chain_.joints(); ++i) {
    const auto k = static_cast<size_t>(i);
    if (i == 0) {
      rotation_[k].setIdentity();
      origin_[k].setZero();
    } else {
      rotation_[k] = rotation_[k - 1];
      origin_[k] = origin_[k - 1];
    }
    chain_.advance(i, q[i], rotation_[k], origin_[k]);
  }
  last_ = q;
  known_ = chain_.joints();
  const auto end = static_cast<size_t>(chain_.joints() - 1);
  Pose out = Pose::Identity();
  out.linear().noalias() = rotation_[end] * chain_.tool_rotation();
  out.translation() = origin_[end];
  out.translation().noalias() += rotation_[end] * chain_.tool_offset();
  return out;
}

}  // namespace viapoint
