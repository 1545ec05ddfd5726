#include "kinematics/parallel_wrist.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/units.hpp"

namespace viapoint {

std::optional<ParallelWrist> ParallelWrist::recognise(const ForwardKinematics& forward) {
  if (forward.joints() != 6) return std::nullopt;
  for (int i = 0; i < 6; ++i) {
    if (forward.type(i) != JointType::kRevolute) return std::nullopt;
  }
  const ChainFrames zero = forward.frames(JointVector::Zero(6));
  const auto& axis = zero.axis;
  if (std::abs(axis[0].dot(axis[1])) > kExactAxes || axis[1].cross(axis[2]).norm() > kExactAxes ||
      axis[1].cross(axis[3]).norm() > kExactAxes || std::abs(axis[3].dot(axis[4])) > kExactAxes ||
      std::abs(axis[4].dot(axis[5])) > kExactAxes) {
    return std::nullopt;
  }
  const auto meeting = nearest_point(zero.origin[4], axis[4], zero.origin[5], axis[5]);
  if (!meeting || axis[5].cross(*meeting - zero.origin[5]).norm() > kExactAxes) {
    return std::nullopt;
  }

  ParallelWrist arm;
  arm.pose_base_s_ = shoulder_frame(zero);
  const Pose pose_s_base = arm.pose_base_s_.inverse(Eigen::Isometry);
  const auto planar = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d in_s = pose_s_base * point;
    return Planar(in_s.z(), in_s.x());
  };
  arm.shoulder_ = planar(zero.origin[1]);
  arm.upper_ = planar(zero.origin[2]) - arm.shoulder_;
  arm.fore_ = planar(zero.origin[3]) - planar(zero.origin[2]);
  arm.hand_ = planar(*meeting) - planar(zero.origin[3]);
  if (std::abs(arm.upper_) < 1e-6 || std::abs(arm.fore_) < 1e-6) return std::nullopt;
  arm.side_ = (pose_s_base * *meeting).y();
  arm.sign3_ = axis[1].dot(axis[2]) > 0.0 ? 1.0 : -1.0;
  arm.sign4_ = axis[1].dot(axis[3]) > 0.0 ? 1.0 : -1.0;
  arm.axis5_ = pose_s_base.linear() * axis[4];
  arm.axis6_ = pose_s_base.linear() * axis[5];
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  arm.tilt_ = std::atan2(arm.axis6_.dot(arm.axis5_.cross(y)), arm.axis6_.dot(y));
  arm.rotation_s_tool_ = pose_s_base.linear() * zero.pose_base_tool.linear();
  arm.meeting_in_tool_ = zero.pose_base_tool.inverse(Eigen::Isometry) * *meeting;
  return arm;
}

std::string ParallelWrist::family() const {
  return "three parallel axes: 2, 3, 4, and axes 5, 6 meet in one point";
}

void ParallelWrist::solve(const InverseTask& task, const JointVector& held,
                          ClosedSolutions& solutions) const {
  const Pose pose_s_tool = pose_base_s_.inverse(Eigen::Isometry) * task.goal;
  const Eigen::Vector3d meeting = pose_s_tool * meeting_in_tool_;
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d aside = axis5_.cross(y);
  const ShoulderBranches shoulders = turn_shoulder(meeting.x(), meeting.y(), side_, held[0]);
  double missing = shoulders.out_of_reach;
  for (const ShoulderBranch& shoulder : shoulders) {
    // Without joint 1: R = Ry(S) R5 R6 with S = q2 ± q3 ± q4, and turns about y leave y as it is.
    const Eigen::Matrix3d rotation =
        about_z(-shoulder.q1) * pose_s_tool.linear() * rotation_s_tool_.transpose();
    const Eigen::Vector3d direction = rotation * axis6_;
    const double sine = std::hypot(direction.x(), direction.z());
    const bool aligned = sine < kWristSine;  // axis 6 along axes 2, 3, 4
    const double bend = std::atan2(aligned ? 0.0 : sine, direction.y());
    for (const double theta : {bend, -bend}) {
      if (aligned && theta != bend) continue;
      const double q5 = theta - tilt_;
      // y seen from the tool: Rᵀ y = R6ᵀ (R5ᵀ y). Both sides are taken across axis 6 before they
      // are compared: near the singularity they differ in the last digits only.
      const Eigen::Vector3d seen = axis6_.cross(rotation.transpose() * y);
      const Eigen::Vector3d turned = axis6_.cross(std::cos(q5) * y - std::sin(q5) * aside);
      const double q6 =
          aligned ? held[5] : std::atan2(axis6_.dot(seen.cross(turned)), seen.dot(turned));
      const Eigen::Matrix3d left = rotation * Eigen::AngleAxisd(-q6, axis6_).toRotationMatrix() *
                                   Eigen::AngleAxisd(-q5, axis5_).toRotationMatrix();
      const double sum = std::atan2(left(0, 2) - left(2, 0), left(0, 0) + left(2, 2));
      // Joints 2 and 3 carry axis 4 to its place, joint 4 makes up the sum.
      const Planar target =
          Planar(meeting.z(), shoulder.forward) - std::polar(1.0, sum) * hand_ - shoulder_;
      const Elbow elbow = bend_elbow(std::abs(upper_), std::abs(fore_), std::abs(target));
      solutions.held = solutions.held || aligned;
      if (!elbow.solved) {
        missing = missing == 0.0 ? elbow.out_of_reach : std::min(missing, elbow.out_of_reach);
        continue;
      }
      for (const double gamma : {elbow.angle, -elbow.angle}) {
        const double turn3 = gamma - std::arg(fore_) + std::arg(upper_);
        const Planar span = std::abs(upper_) + std::polar(std::abs(fore_), gamma);
        const double q2 = std::abs(target) < kOnAxis
                              ? held[1]
                              : std::arg(target) - std::arg(upper_) - std::arg(span);
        ClosedBranch& branch = solutions.branches.add();
        branch.q.resize(6);
        branch.q << shoulder.q1, q2, sign3_ * turn3, sign4_ * (sum - q2 - turn3), q5, q6;
        if (elbow.angle == 0.0) break;  // stretched: both elbows are one
      }
    }
  }
  if (solutions.branches.empty()) solutions.out_of_reach = missing;
}

ArmSides ParallelWrist::sides(const JointVector& q) const {
  const double turn3 = q[1] + sign3_ * q[2];
  const double turn4 = turn3 + sign4_ * q[3];
  const Planar meeting = shoulder_ + std::polar(1.0, q[1]) * upper_ +
                         std::polar(1.0, turn3) * fore_ + std::polar(1.0, turn4) * hand_;
  ArmSides found;
  found.length = std::abs(upper_) + std::abs(fore_);
  found.shoulder = meeting.imag();
  found.elbow = from_half_turns(sign3_ * q[2] + std::arg(fore_) - std::arg(upper_));
  found.wrist = from_half_turns(q[4] + tilt_);
  return found;
}

}  // namespace viapoint
