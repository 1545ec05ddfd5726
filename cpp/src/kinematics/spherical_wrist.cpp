#include "kinematics/spherical_wrist.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "viapoint/core/units.hpp"

namespace viapoint {

std::optional<SphericalWrist> SphericalWrist::recognise(const ForwardKinematics& forward,
                                                        double exactly) {
  if (forward.joints() != 6) return std::nullopt;
  for (int i = 0; i < 6; ++i) {
    if (forward.type(i) != JointType::kRevolute) return std::nullopt;
  }
  const ChainFrames zero = forward.frames(JointVector::Zero(6));
  const auto& axis = zero.axis;
  const auto& origin = zero.origin;
  if (std::abs(axis[0].dot(axis[1])) > exactly || axis[1].cross(axis[2]).norm() > exactly ||
      std::abs(axis[3].dot(axis[4])) > exactly || std::abs(axis[4].dot(axis[5])) > exactly) {
    return std::nullopt;
  }
  const auto centre = nearest_point(origin[4], axis[4], origin[3], axis[3]);
  if (!centre || axis[3].cross(*centre - origin[3]).norm() > exactly ||
      axis[5].cross(*centre - origin[5]).norm() > exactly) {
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
  arm.fore_zero_ = {Lanes::Constant(std::cos(arm.fore_angle_)),
                    Lanes::Constant(-std::sin(arm.fore_angle_))};
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
  const Eigen::Matrix3d rotation = pose_s_base_.linear() * task.goal.linear();
  const Eigen::Vector3d wrist = pose_s_base_ * task.goal.translation() + rotation * wrist_in_tool_;
  solutions.confirmed = true;

  // Joint 1 turns the arm's plane, which passes axis 1 at the distance |side|.
  const ShoulderTurns shoulder = turn_shoulder(wrist.x(), wrist.y(), side_, held[0]);
  if (shoulder.missing > kBoundary) {
    solutions.out_of_reach = shoulder.missing;
    return;
  }
  // Lanes: shoulder before, elbow one way and the other; shoulder behind, the same.
  const LaneTurn first{in_pairs(shoulder.cosine), in_pairs(shoulder.sine)};
  const Lanes ahead = shoulder.forward * in_pairs({1.0, -1.0}) - shoulder_x_;

  // Joints 2 and 3 are a planar arm in (z, x): turning about y by θ multiplies z + ix by e^{iθ}.
  const Lanes span = (ahead * ahead + wrist.z() * wrist.z()).sqrt();
  const LaneElbow elbow = bend_elbow(upper_, fore_, span, Lanes(1.0, -1.0, 1.0, -1.0));
  const Lanes span_z = upper_ + fore_ * elbow.bend.cosine;
  const Lanes span_x = fore_ * elbow.bend.sine;
  // The upper arm's turn carries span to (ahead, z).
  LaneTurn upper =
      LaneTurn::along(wrist.z() * span_z + ahead * span_x, ahead * span_z - wrist.z() * span_x);
  for (int lane = 0; lane < 4; ++lane) {
    if (span[lane] >= kOnAxis) continue;
    upper.cosine[lane] = std::cos(held[1] + upper_angle_);
    upper.sine[lane] = std::sin(held[1] + upper_angle_);
  }
  const Lanes off_z = upper.cosine * span_z - upper.sine * span_x - wrist.z();
  const Lanes off_x = upper.sine * span_z + upper.cosine * span_x - ahead;
  const Lanes place_off = (off_z * off_z + off_x * off_x + shoulder.off_square).sqrt();

  const LaneTurn fore = turned(turned(upper, elbow.bend), fore_zero_);
  const WristLanes bent = turn_wrist(first, fore, rotation * rotation_tool_wrist_, held[3]);
  const Lanes off = place_off + bent.angle_off * wrist_in_tool_.norm();

  enum : size_t { kQ1 = 0, kBend = 2, kUpper = 4, kQ4 = 8, kTheta = 12, kQ6 = 16, kAngles = 20 };
  AngleLanes<kAngles> angles;
  for (const Eigen::Index which : {0, 1}) {
    const auto k = static_cast<size_t>(which);
    angles.put(kQ1 + k, shoulder.cosine[which], shoulder.sine[which]);
    angles.put(kBend + k, elbow.bend.cosine[2 * which], elbow.bend.sine[2 * which]);
  }
  angles.put(kUpper, upper);
  angles.put(kQ4, bent.q4);
  angles.put(kTheta, bent.theta);
  angles.put(kQ6, bent.q6);
  angles.solve();

  double missing = 0.0;
  bool meeting = shoulder.meet;
  const auto half_turn = [](double angle) { return angle > 0.0 ? angle - kPi : angle + kPi; };
  for (size_t lane = 0; lane < 4; ++lane) {
    const auto k = static_cast<Eigen::Index>(lane);
    if (elbow.missing[k] > kBoundary) {
      missing = missing == 0.0 ? elbow.missing[k] : std::min(missing, elbow.missing[k]);
      continue;
    }
    if (!(off[k] <= kFormTolerance && bent.angle_off[k] <= kFormTolerance)) continue;
    meeting = meeting || std::abs(elbow.bend.sine[k]) < kMeeting || bent.sine[k] < kMeeting;
    const double bend = lane % 2 == 0 ? angles[kBend + lane / 2] : -angles[kBend + lane / 2];
    ClosedBranch& branch = solutions.branches.add();
    branch.q.resize(6);
    branch.q[0] = angles[kQ1 + lane / 2];
    branch.q[1] = angles[kUpper + lane] - upper_angle_;
    branch.q[2] = elbow_sign_ * (bend - fore_angle_ + upper_angle_);
    branch.q[3] = angles[kQ4 + lane];
    branch.q[4] = angles[kTheta + lane] - tilt_;
    branch.q[5] = angles[kQ6 + lane];
    if (bent.sine[k] < kWristSine) {
      branch.wrist_free = true;
      branch.first = 3;
      branch.second = 5;
      branch.wrist_sign = bent.theta.cosine[k] > 0.0 ? 1.0 : -1.0;
      branch.wrist_sum = branch.q[3] + branch.wrist_sign * branch.q[5];
      continue;
    }
    // The other side: half a turn of joints 4 and 6, and the bend the other way.
    ClosedBranch& flipped = solutions.branches.add();
    flipped.q = branch.q;
    flipped.q[3] = half_turn(branch.q[3]);
    flipped.q[4] = -angles[kTheta + lane] - tilt_;
    flipped.q[5] = half_turn(branch.q[5]);
  }
  solutions.meeting = meeting;
  if (solutions.branches.empty()) solutions.out_of_reach = missing;
}

SphericalWrist::WristLanes SphericalWrist::turn_wrist(const LaneTurn& first, const LaneTurn& fore,
                                                      const Eigen::Matrix3d& goal,
                                                      double held) const {
  // What is left for the wrist, in its own frame:
  // N = Wᵀ Ry(−q2 ∓ q3) Rz(−q1) goal = Rz(q4) Ry(θ) Rz(q6).
  std::array<std::array<Lanes, 3>, 3> n;
  for (int j = 0; j < 3; ++j) {
    const Lanes x = first.cosine * goal(0, j) + first.sine * goal(1, j);
    const Lanes y = first.cosine * goal(1, j) - first.sine * goal(0, j);
    const Lanes along_x = fore.cosine * x - fore.sine * goal(2, j);
    const Lanes along_z = fore.sine * x + fore.cosine * goal(2, j);
    for (int i = 0; i < 3; ++i) {
      n[static_cast<size_t>(i)][static_cast<size_t>(j)] = rotation_s_wrist_(0, i) * along_x +
                                                          rotation_s_wrist_(1, i) * y +
                                                          rotation_s_wrist_(2, i) * along_z;
    }
  }
  WristLanes out;
  out.sine = (n[0][2] * n[0][2] + n[1][2] * n[1][2]).sqrt();
  const Lanes scale = out.sine.max(kWristSine).inverse();
  out.q4 = {n[0][2] * scale, n[1][2] * scale};
  if ((out.sine < kWristSine).any()) {  // axes 4 and 6 in line: joint 4 stays
    const double c = std::cos(held);
    const double s = std::sin(held);
    out.q4.cosine = (out.sine < kWristSine).select(c, out.q4.cosine);
    out.q4.sine = (out.sine < kWristSine).select(s, out.q4.sine);
  }
  // With q4 known the other two follow without loss, however small the sine: M = Rz(−q4) N =
  // Ry(θ) Rz(q6), whose middle row is (sin q6, cos q6, 0) and whose last column (sin θ, 0, cos θ).
  std::array<Lanes, 3> top;
  std::array<Lanes, 3> middle;
  for (size_t j = 0; j < 3; ++j) {
    top[j] = out.q4.cosine * n[0][j] + out.q4.sine * n[1][j];
    middle[j] = out.q4.cosine * n[1][j] - out.q4.sine * n[0][j];
  }
  out.theta = LaneTurn::along(n[2][2], top[2]);
  out.q6 = LaneTurn::along(middle[1], middle[0]);
  // The forward kinematics of what was found against M: ‖A − B‖ = √2 · angle, for small ones.
  const auto square = [](const Lanes& value) { return value * value; };
  const LaneTurn& t = out.theta;
  const LaneTurn& r = out.q6;
  const Lanes sum = square(top[0] - t.cosine * r.cosine) + square(top[1] + t.cosine * r.sine) +
                    square(top[2] - t.sine) + square(middle[0] - r.sine) +
                    square(middle[1] - r.cosine) + square(middle[2]) +
                    square(n[2][0] + t.sine * r.cosine) + square(n[2][1] - t.sine * r.sine) +
                    square(n[2][2] - t.cosine);
  out.angle_off = (0.5 * sum).sqrt();
  return out;
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
