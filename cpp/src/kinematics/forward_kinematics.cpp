#include "viapoint/kinematics/forward_kinematics.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

/// A rotation that carries z to `axis`; the identity, exactly, where they are the same.
Eigen::Matrix3d rotation_from_z(const Eigen::Vector3d& axis) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (axis == Eigen::Vector3d::UnitZ()) return rotation;
  rotation.col(0) = axis.unitOrthogonal();
  rotation.col(1) = axis.cross(rotation.col(0));
  rotation.col(2) = axis;
  return rotation;
}

/// frame ← frame · (turn about, or slide along, z by q).
void move_joint(Pose& frame, JointType type, double q) {
  if (type == JointType::kPrismatic) {
    frame.translation() += q * frame.linear().col(2);
    return;
  }
  const double c = std::cos(q);
  const double s = std::sin(q);
  const Eigen::Vector3d x = frame.linear().col(0);
  const Eigen::Vector3d y = frame.linear().col(1);
  frame.linear().col(0) = c * x + s * y;
  frame.linear().col(1) = c * y - s * x;
}

}  // namespace

ForwardKinematics::ForwardKinematics(std::span<const ChainJoint> joints, const Pose& tool)
    : joints_(static_cast<int>(joints.size())) {
  if (joints.size() > static_cast<size_t>(kMaxJoints)) {
    throw MotionError(ErrorCode::kBadRobot, "a chain of " + std::to_string(joints.size()) +
                                                " joints: at most " + std::to_string(kMaxJoints) +
                                                " are supported");
  }
  // Every joint frame is turned so that its axis is z: the walk then needs no axis-angle formula.
  Eigen::Matrix3d to_axis = Eigen::Matrix3d::Identity();
  for (size_t i = 0; i < joints.size(); ++i) {
    const Eigen::Matrix3d next = rotation_from_z(joints[i].axis.normalized());
    chain_[i].type = joints[i].type;
    chain_[i].before.linear() = to_axis.transpose() * joints[i].before.linear() * next;
    chain_[i].before.translation() = to_axis.transpose() * joints[i].before.translation();
    to_axis = next;
  }
  tool_.linear() = to_axis.transpose() * tool.linear();
  tool_.translation() = to_axis.transpose() * tool.translation();
}

ChainFrames ForwardKinematics::frames(const JointVector& q) const {
  ChainFrames out;
  Pose frame = Pose::Identity();
  for (int i = 0; i < joints_; ++i) {
    const auto k = static_cast<size_t>(i);
    frame = frame * chain_[k].before;
    out.axis[k] = frame.linear().col(2);
    out.origin[k] = frame.translation();
    move_joint(frame, chain_[k].type, q[i]);
  }
  out.pose_base_tool = frame * tool_;
  return out;
}

Pose ForwardKinematics::pose(const JointVector& q) const {
  Pose frame = Pose::Identity();
  for (int i = 0; i < joints_; ++i) {
    const auto k = static_cast<size_t>(i);
    frame = frame * chain_[k].before;
    move_joint(frame, chain_[k].type, q[i]);
  }
  return frame * tool_;
}

Jacobian ForwardKinematics::jacobian(const ChainFrames& frames) const {
  Jacobian out(6, joints_);
  const Eigen::Vector3d tool = frames.pose_base_tool.translation();
  for (int i = 0; i < joints_; ++i) {
    const auto k = static_cast<size_t>(i);
    if (chain_[k].type == JointType::kRevolute) {
      out.col(i).head<3>() = frames.axis[k].cross(tool - frames.origin[k]);
      out.col(i).tail<3>() = frames.axis[k];
    } else {
      out.col(i).head<3>() = frames.axis[k];
      out.col(i).tail<3>().setZero();
    }
  }
  return out;
}

Jacobian ForwardKinematics::jacobian_rate(const ChainFrames& frames, const JointVector& qd) const {
  // Outward: how each axis turns and each origin moves with the links before it.
  std::array<Eigen::Vector3d, kMaxJoints> axis_rate;
  std::array<Eigen::Vector3d, kMaxJoints> origin_rate;
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (int i = 0; i < joints_; ++i) {
    const auto k = static_cast<size_t>(i);
    velocity += spin.cross(frames.origin[k] - point);
    point = frames.origin[k];
    axis_rate[k] = spin.cross(frames.axis[k]);
    origin_rate[k] = velocity;
    if (chain_[k].type == JointType::kRevolute) {
      spin += qd[i] * frames.axis[k];
    } else {
      velocity += qd[i] * frames.axis[k];
    }
  }
  const Eigen::Vector3d tool = frames.pose_base_tool.translation();
  const Eigen::Vector3d tool_rate = velocity + spin.cross(tool - point);

  Jacobian out(6, joints_);
  for (int i = 0; i < joints_; ++i) {
    const auto k = static_cast<size_t>(i);
    if (chain_[k].type == JointType::kRevolute) {
      out.col(i).head<3>() = axis_rate[k].cross(tool - frames.origin[k]) +
                             frames.axis[k].cross(tool_rate - origin_rate[k]);
      out.col(i).tail<3>() = axis_rate[k];
    } else {
      out.col(i).head<3>() = axis_rate[k];
      out.col(i).tail<3>().setZero();
    }
  }
  return out;
}

JointVector ForwardKinematics::reach_bound(const JointVector& travel) const {
  // From the tool inwards: a cylinder about each axis (radius, and a stretch [low, high] of the
  // axis) that holds every place the tool point can be, seen from that joint's frame.
  JointVector bound(joints_);
  Eigen::Vector3d offset = tool_.translation();
  double radius = 0.0;
  double low = 0.0;
  double high = 0.0;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // of the outer cylinder, seen from this joint
  for (int i = joints_ - 1; i >= 0; --i) {
    const auto k = static_cast<size_t>(i);
    // A ball about the outer joint's origin holds its cylinder, and so does the cylinder itself:
    // each gives a radius and a stretch about this axis, and the smaller ones hold both.
    const double ball = std::hypot(radius, std::max(std::abs(low), std::abs(high)));
    const double cosine = axis.z();
    const double sine = axis.head<2>().norm();
    const double across =
        std::max((offset + low * axis).head<2>().norm(), (offset + high * axis).head<2>().norm());
    const double spread = radius * sine;
    const double inner_radius = std::min(offset.head<2>().norm() + ball, across + radius);
    const double inner_low =
        offset.z() + std::max(-ball, std::min(low * cosine, high * cosine) - spread);
    const double inner_high =
        offset.z() + std::min(ball, std::max(low * cosine, high * cosine) + spread);
    const double slide = chain_[k].type == JointType::kPrismatic ? std::abs(travel[i]) : 0.0;
    radius = inner_radius;
    low = inner_low - slide;
    high = inner_high + slide;
    bound[i] = radius;
    offset = chain_[k].before.translation();
    axis = chain_[k].before.linear().col(2);
  }
  return bound;
}

}  // namespace viapoint
