#include "kinematics/spherical_wrist.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/units.hpp"

namespace viapoint {
std::optional<SphericalWrist> SphericalWrist::recognise(const ForwardKinematics& forward) {
  if (forward.joints() != 6) return std::nullopt;
  for (int i = 0; i < 6; ++i) {
    if (forward.type(i) != JointType::kRevolute) return std::nullopt;
  }
  const ChainFrames zero = forward.frames(JointVector::Zero(6));
  const auto& axis = zero.axis;
  const auto& origin = zero.origin;
  if (std::abs(axis[0].dot(axis[1])) > kExactAxes || axis[1].cross(axis[2]).norm() > kExactAxes ||
      std::abs(axis[3].dot(axis[4])) > kExactAxes || std::abs(axis[4].dot(axis[5])) > kExactAxes) {
    return std::nullopt;
  }
  const auto centre = nearest_point(origin[4], axis[4], origin[3], axis[3]);
  if (!centre || axis[3].cross(*centre - origin[3]).norm() > kExactAxes ||
      axis[5].cross(*centre - origin[5]).norm() > kExactAxes) {
    return std::nullopt;
  }

  SphericalWrist arm;
  const Pose pose_s_base = shoulder_frame(zero).inverse(Eigen::Isometry);
  arm.pose_s_base_ = pose_s_base;
  const Eigen::Vector3d shoulder = pose_s_base * origin[1];
  const Eigen::Vector3d elbow = pose_s_base * origin[2];
  const Eigen::Vector3d wrist = pose_s_base * *centre;
  arm.shoulder_x_ = shoulder.x();
  arm.side_ = wrist.y();
  arm.upper_ = std::hypot(elbow.x() - shoulder.x(), elbow.z() - shoulder.z());
  arm.fore_ = std::hypot(wrist.x() - elbow.x(), wrist.z() - elbow.z());
  if (arm.upper_ < 1e-6 || arm.fore_ < 1e-6) return std::nullopt;
  arm.upper_angle_ = std::atan2(elbow.x() - shoulder.x(), elbow.z() - shoulder.z());
  arm.fore_angle_ = std::atan2(wrist.x() - elbow.x(), wrist.z() - elbow.z());
  arm.elbow_sign_ = axis[1].dot(axis[2]) > 0.0 ? 1.0 : -1.0;

  Eigen::Matrix3d wrist_frame;
  wrist_frame.col(1) = axis[4];
  wrist_frame.col(2) = (axis[3] - axis[3].dot(axis[4]) * axis[4]).normalized();
  wrist_frame.col(0) = wrist_frame.col(1).cross(wrist_frame.col(2));
  arm.tilt_ = std::atan2(axis[5].dot(wrist_frame.col(0)), axis[5].dot(wrist_frame.col(2)));
  arm.rotation_s_wrist_ = pose_s_base.linear() * wrist_frame;
  arm.rotation_tool_wrist_ = zero.pose_base_tool.linear().transpose() *
                             pose_s_base.linear().transpose() * arm.rotation_s_wrist_ *
                             about_y(arm.tilt_);
  arm.wrist_in_tool_ = zero.pose_base_tool.inverse(Eigen::Isometry) * *centre;
  return arm;
}

std::string SphericalWrist::family() const {
  return "spherical wrist: axes 4, 5, 6 meet in one point";
}

void SphericalWrist::solve(const InverseTask& task, const JointVector& held,
                           ClosedSolutions& solutions) const {
  const Pose pose_s_tool = pose_s_base_ * task.goal;
  const Eigen::Vector3d wrist = pose_s_tool * wrist_in_tool_;
  const Eigen::Matrix3d turned = pose_s_tool.linear() * rotation_tool_wrist_;

  // Joint 1 turns the arm's plane, which passes axis 1 at the distance |side|.
  const ShoulderBranches shoulders = turn_shoulder(wrist.x(), wrist.y(), side_, held[0]);
  double missing = shoulders.out_of_reach;
  for (const ShoulderBranch& shoulder : shoulders) {
    // Joints 2 and 3 are a planar arm in (z, x): turning about y by θ multiplies z + ix by e^{iθ}.
    const double ahead = shoulder.forward - shoulder_x_;
    const double span = std::sqrt(ahead * ahead + wrist.z() * wrist.z());
    const Elbow elbow = bend_elbow(upper_, fore_, span);
    if (!elbow.solved) {
      missing = missing == 0.0 ? elbow.out_of_reach : std::min(missing, elbow.out_of_reach);
      continue;
    }
    const Eigen::Matrix3d before = about_z(-shoulder.q1) * turned;
    for (const double side : {1.0, -1.0}) {
      const double bend = side * elbow.angle;
      const double span_z = upper_ + fore_ * elbow.cosine;
      const double span_x = side * fore_ * elbow.sine;
      // The upper arm's turn carries span to (ahead, z).
      const double turn =
          std::atan2(ahead * span_z - wrist.z() * span_x, wrist.z() * span_z + ahead * span_x);
      const double q2 = span < kOnAxis ? held[1] : turn - upper_angle_;
      const double q3 = elbow_sign_ * (bend - fore_angle_ + upper_angle_);
      solve_wrist(before, Eigen::Vector3d(shoulder.q1, q2, q3), held, solutions.branches);
      if (elbow.angle == 0.0) break;  // stretched: both elbows are one
    }
  }
  if (solutions.branches.empty()) solutions.out_of_reach = missing;
}

void SphericalWrist::solve_wrist(const Eigen::Matrix3d& before, const Eigen::Vector3d& arm,
                                 const JointVector& held, BranchList& out) const {
  // What is left for the wrist, in its own frame: N = Rz(q4) Ry(q5 + tilt) Rz(q6).
  const Eigen::Matrix3d n =
      rotation_s_wrist_.transpose() * about_y(-(arm[1] + elbow_sign_ * arm[2])) * before;
  const double sine = std::sqrt(n(0, 2) * n(0, 2) + n(1, 2) * n(1, 2));

  // With q4 known the other two follow without loss, however small the sine:
  // Rz(−q4) N = Ry(θ) Rz(q6), whose middle row is (sin q6, cos q6, 0).
  const auto finish = [&](double q4, double c, double s) -> ClosedBranch& {
    ClosedBranch& branch = out.add();
    branch.q.resize(6);
    branch.q << arm[0], arm[1], arm[2], q4, std::atan2(c * n(0, 2) + s * n(1, 2), n(2, 2)) - tilt_,
        std::atan2(c * n(1, 0) - s * n(0, 0), c * n(1, 1) - s * n(0, 1));
    return branch;
  };
  if (sine < kWristSine) {
    ClosedBranch& branch = finish(held[3], std::cos(held[3]), std::sin(held[3]));
    branch.wrist_free = true;
    branch.first = 3;
    branch.second = 5;
    branch.wrist_sign = n(2, 2) > 0.0 ? 1.0 : -1.0;
    branch.wrist_sum = branch.q[3] + branch.wrist_sign * branch.q[5];
    return;
  }
  const double q4 = std::atan2(n(1, 2), n(0, 2));
  const ClosedBranch& bent = finish(q4, n(0, 2) / sine, n(1, 2) / sine);
  // The other side: half a turn of joints 4 and 6, and the bend the other way.
  const auto half_turn = [](double angle) { return angle > 0.0 ? angle - kPi : angle + kPi; };
  ClosedBranch& flipped = out.add();
  flipped.q = bent.q;
  flipped.q[3] = half_turn(q4);
  flipped.q[4] = -(bent.q[4] + tilt_) - tilt_;
  flipped.q[5] = half_turn(bent.q[5]);
}

ArmSides SphericalWrist::sides(const JointVector& q) const {
  const double upper = upper_angle_ + q[1];
  const double fore = fore_angle_ + q[1] + elbow_sign_ * q[2];
  ArmSides found;
  found.length = upper_ + fore_;
  found.shoulder = shoulder_x_ + upper_ * std::sin(upper) + fore_ * std::sin(fore);
  found.elbow = from_half_turns(fore - upper);
  found.wrist = from_half_turns(q[4] + tilt_);
  return found;
}

}  // namespace viapoint
