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
  const Pose pose_s_base = shoulder_frame(zero).inverse(Eigen::Isometry);
  arm.pose_s_base_ = pose_s_base;
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
  arm.cos_tilt_ = std::cos(arm.tilt_);
  arm.sin_tilt_ = std::sin(arm.tilt_);
  arm.axis65_ = arm.axis6_.cross(arm.axis5_);
  arm.y_across_ = arm.axis6_.cross(y);
  arm.aside_across_ = arm.axis6_.cross(arm.axis5_.cross(y));
  arm.upper_length_ = std::abs(arm.upper_);
  arm.fore_length_ = std::abs(arm.fore_);
  arm.upper_angle_ = std::arg(arm.upper_);
  arm.turn3_zero_ = arm.upper_angle_ - std::arg(arm.fore_);
  arm.rotation_s_tool_ = pose_s_base.linear() * zero.pose_base_tool.linear();
  arm.meeting_in_tool_ = zero.pose_base_tool.inverse(Eigen::Isometry) * *meeting;
  return arm;
}

std::string ParallelWrist::family() const {
  return "three parallel axes: 2, 3, 4, and axes 5, 6 meet in one point";
}

void ParallelWrist::solve(const InverseTask& task, const JointVector& held,
                          ClosedSolutions& solutions) const {
  const Pose pose_s_tool = pose_s_base_ * task.goal;
  const Eigen::Vector3d meeting = pose_s_tool * meeting_in_tool_;
  const Eigen::Matrix3d turned = pose_s_tool.linear() * rotation_s_tool_.transpose();
  const ShoulderBranches shoulders = turn_shoulder(meeting.x(), meeting.y(), side_, held[0]);
  solutions.out_of_reach = shoulders.out_of_reach;
  for (const ShoulderBranch& shoulder : shoulders) {
    // Without joint 1: R = Ry(S) R5 R6 with S = q2 ± q3 ± q4, and turns about y leave y as it is.
    const Eigen::Matrix3d rotation = about_z(-shoulder.q1) * turned;
    const Eigen::Vector3d direction = rotation * axis6_;
    const double sine = std::hypot(direction.x(), direction.z());
    const Planar place = Planar(meeting.z(), shoulder.forward) - shoulder_;
    if (sine < kWristSine) {  // axis 6 along axes 2, 3, 4
      solutions.held = true;
      const double bend = direction.y() > 0.0 ? 0.0 : kPi;
      solve_arm(rotation, shoulder.q1, place, {bend - tilt_, held[5], sine}, held, solutions);
      continue;
    }
    // y seen from the tool: Rᵀ y = R6ᵀ (R5ᵀ y). Both sides are taken across axis 6 before they are
    // compared: near the singularity they differ in the last digits only.
    const Eigen::Vector3d seen = axis6_.cross(rotation.row(1).transpose());
    const double bend = std::atan2(sine, direction.y());
    for (const double theta : {sine, -sine}) {
      const double c5 = direction.y() * cos_tilt_ + theta * sin_tilt_;  // of q5 = ±bend − tilt
      const double s5 = theta * cos_tilt_ - direction.y() * sin_tilt_;
      const Eigen::Vector3d aim = c5 * y_across_ - s5 * aside_across_;
      const double q6 = std::atan2(axis6_.dot(seen.cross(aim)), seen.dot(aim));
      const double q5 = std::copysign(bend, theta) - tilt_;
      solve_arm(rotation, shoulder.q1, place, {q5, q6, sine}, held, solutions);
    }
  }
  if (!solutions.branches.empty()) solutions.out_of_reach = 0.0;
}

void ParallelWrist::solve_arm(const Eigen::Matrix3d& rotation, double q1, const Planar& place,
                              Wrist wrist, const JointVector& held,
                              ClosedSolutions& solutions) const {
  // R5 leaves axis 5 where it is: R R6ᵀ axis5 = Ry(S) axis5, square to y.
  const auto sum_with = [&](double q6) {
    const Eigen::Vector3d carried = rotation * (std::cos(q6) * axis5_ - std::sin(q6) * axis65_);
    const Planar turn(axis5_.dot(carried), axis5_.z() * carried.x() - axis5_.x() * carried.z());
    return turn / std::sqrt(std::norm(turn));
  };
  // Joints 2 and 3 carry axis 4 to its place, joint 4 makes up the sum.
  Planar turn = sum_with(wrist.q6);
  Planar target = place - turn * hand_;
  Elbow elbow = bend_elbow(upper_length_, fore_length_, std::sqrt(std::norm(target)));
  if (!elbow.solved) {
    // Near alignment the pose's rounding leaves q6 open by about rounding / sine: within that the
    // wrist turns so far that the arm reaches.
    constexpr double kRounding = 1e-14;
    const Planar moved = Planar(0.0, -1.0) * turn * hand_;  // of the target, with the sum
    const double rate = std::real(std::conj(target) * moved) / std::abs(target);
    const bool far = std::abs(target) > upper_length_;
    const double shift = (far ? -1.0 : 1.0) * elbow.out_of_reach / rate;
    if (std::abs(shift) < kRounding / std::max(wrist.sine, kRounding)) {
      const double way = rotation.row(1).dot(axis6_) > 0.0 ? -1.0 : 1.0;
      wrist.q6 += way * shift;
      turn = sum_with(wrist.q6);
      target = place - turn * hand_;
      elbow = bend_elbow(upper_length_, fore_length_, std::abs(target));
    }
  }
  if (!elbow.solved) {
    double& missing = solutions.out_of_reach;
    missing = missing == 0.0 ? elbow.out_of_reach : std::min(missing, elbow.out_of_reach);
    return;
  }
  const double sum = std::arg(turn);
  const bool folded = std::norm(target) < kOnAxis * kOnAxis;
  for (const double side : {1.0, -1.0}) {
    const Planar span(upper_length_ + fore_length_ * elbow.cosine,
                      side * fore_length_ * elbow.sine);
    const double turn3 = side * elbow.angle + turn3_zero_;
    const double q2 = folded ? held[1] : std::arg(target * std::conj(span)) - upper_angle_;
    ClosedBranch& branch = solutions.branches.add();
    branch.q.resize(6);
    branch.q << q1, q2, sign3_ * turn3, sign4_ * (sum - q2 - turn3), wrist.q5, wrist.q6;
    if (elbow.angle == 0.0) break;  // stretched: both elbows are one
  }
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
