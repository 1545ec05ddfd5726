#include "kinematics/parallel_wrist.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "viapoint/core/units.hpp"

namespace viapoint {

std::optional<ParallelWrist> ParallelWrist::recognise(const ForwardKinematics& forward,
                                                      double exactly) {
  if (forward.joints() != 6) return std::nullopt;
  for (int i = 0; i < 6; ++i) {
    if (forward.type(i) != JointType::kRevolute) return std::nullopt;
  }
  const ChainFrames zero = forward.frames(JointVector::Zero(6));
  const auto& axis = zero.axis;
  if (std::abs(axis[0].dot(axis[1])) > exactly || axis[1].cross(axis[2]).norm() > exactly ||
      axis[1].cross(axis[3]).norm() > exactly || std::abs(axis[3].dot(axis[4])) > exactly ||
      std::abs(axis[4].dot(axis[5])) > exactly) {
    return std::nullopt;
  }
  const auto meeting = nearest_point(zero.origin[4], axis[4], zero.origin[5], axis[5]);
  if (!meeting || axis[5].cross(*meeting - zero.origin[5]).norm() > exactly) {
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
  // The wrist's frame: x along axis 5, y along axes 2, 3, 4.
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d axis5 = pose_s_base.linear() * axis[4];
  arm.rotation_s_wrist_.col(0) = (axis5 - axis5.y() * y).normalized();
  arm.rotation_s_wrist_.col(1) = y;
  arm.rotation_s_wrist_.col(2) = arm.rotation_s_wrist_.col(0).cross(y);
  const Eigen::Vector3d axis6 = arm.rotation_s_wrist_.transpose() * pose_s_base.linear() * axis[5];
  arm.tilt_ = std::atan2(axis6.z(), axis6.y());
  arm.upper_length_ = std::abs(arm.upper_);
  arm.fore_length_ = std::abs(arm.fore_);
  arm.upper_angle_ = std::arg(arm.upper_);
  arm.turn3_zero_ = arm.upper_angle_ - std::arg(arm.fore_);
  arm.rotation_tool_wrist_ = zero.pose_base_tool.linear().transpose() *
                             pose_s_base.linear().transpose() * arm.rotation_s_wrist_ *
                             Eigen::AngleAxisd(arm.tilt_, Eigen::Vector3d::UnitX());
  arm.meeting_in_tool_ = zero.pose_base_tool.inverse(Eigen::Isometry) * *meeting;
  return arm;
}

std::string ParallelWrist::family() const {
  return "three parallel axes: 2, 3, 4, and axes 5, 6 meet in one point";
}

void ParallelWrist::solve(const InverseTask& task, const JointVector& held,
                          ClosedSolutions& solutions) const {
  const Eigen::Matrix3d rotation = pose_s_base_.linear() * task.goal.linear();
  const Eigen::Vector3d meeting =
      pose_s_base_ * task.goal.translation() + rotation * meeting_in_tool_;
  solutions.confirmed = true;
  const ShoulderTurns shoulder = turn_shoulder(meeting.x(), meeting.y(), side_, held[0]);
  if (shoulder.missing > kBoundary) {
    solutions.out_of_reach = shoulder.missing;
    return;
  }
  WristLanes wrist = turn_wrist(shoulder, rotation * rotation_tool_wrist_, held[5]);
  const PlaceLanes place{meeting.z() - shoulder_.real(),
                         shoulder.forward * in_pairs({1.0, -1.0}) - shoulder_.imag()};
  ArmLanes arm = reach_arm(wrist, place, held[1]);
  if (nudge_wrist(arm, wrist)) arm = reach_arm(wrist, place, held[1]);
  const Lanes place_off = (arm.off_square + shoulder.off_square).sqrt();
  const Lanes off = place_off + wrist.angle_off * meeting_in_tool_.norm();

  enum : size_t { kQ1 = 0, kTheta = 2, kQ6 = 4, kSum = 8, kBend = 12, kUp = 16, kDown = 20 };
  AngleLanes<24> angles;
  angles.put(kQ6, wrist.q6);
  angles.put(kSum, wrist.sum);
  angles.put(kBend, arm.bend);
  angles.put(kUp, arm.up);
  angles.put(kDown, arm.down);
  for (const Eigen::Index which : {0, 1}) {
    const auto k = static_cast<size_t>(which);
    angles.put(kQ1 + k, shoulder.cosine[which], shoulder.sine[which]);
    angles.put(kTheta + k, wrist.theta.cosine[2 * which], wrist.theta.sine[2 * which]);
  }
  angles.solve();

  double missing = 0.0;
  bool one = shoulder.meet;
  for (size_t lane = 0; lane < 4; ++lane) {
    const auto k = static_cast<Eigen::Index>(lane);
    const bool flipped = lane % 2 == 1;
    if (wrist.sine[k] < kWristSine) {
      solutions.held = true;
      if (flipped) continue;  // both wrists are one
    }
    if (arm.missing[k] > kBoundary) {
      missing = missing == 0.0 ? arm.missing[k] : std::min(missing, arm.missing[k]);
      continue;
    }
    if (!(off[k] <= kFormTolerance && wrist.angle_off[k] <= kFormTolerance)) continue;
    one = one || arm.bend.sine[k] < kMeeting || wrist.sine[k] < kMeeting;
    const double theta = angles[kTheta + lane / 2];
    for (const bool down : {false, true}) {
      const double turn3 = (down ? -angles[kBend + lane] : angles[kBend + lane]) + turn3_zero_;
      const double q2 = angles[(down ? kDown : kUp) + lane] - upper_angle_;
      ClosedBranch& branch = solutions.branches.add();
      branch.q.resize(6);
      branch.q[0] = angles[kQ1 + lane / 2];
      branch.q[1] = q2;
      branch.q[2] = sign3_ * turn3;
      branch.q[3] = sign4_ * (angles[kSum + lane] - q2 - turn3);
      branch.q[4] = (flipped ? -theta : theta) - tilt_;
      branch.q[5] = angles[kQ6 + lane];
    }
  }
  solutions.meeting = one;
  if (solutions.branches.empty()) solutions.out_of_reach = missing;
}

ParallelWrist::WristLanes ParallelWrist::turn_wrist(const ShoulderTurns& shoulder,
                                                    const Eigen::Matrix3d& goal,
                                                    double held) const {
  // Without joint 1, in the wrist's frame: N = Wᵀ Rz(−q1) goal = Ry(S) Rx(θ) Ry(q6), with
  // S = q2 ± q3 ± q4: turns about y leave y as it is.
  WristLanes out;
  const LaneTurn first{in_pairs(shoulder.cosine), in_pairs(shoulder.sine)};
  for (int j = 0; j < 3; ++j) {
    const Lanes x = first.cosine * goal(0, j) + first.sine * goal(1, j);
    const Lanes y = first.cosine * goal(1, j) - first.sine * goal(0, j);
    for (int i = 0; i < 3; ++i) {
      out.n[static_cast<size_t>(i)][static_cast<size_t>(j)] = rotation_s_wrist_(0, i) * x +
                                                              rotation_s_wrist_(1, i) * y +
                                                              rotation_s_wrist_(2, i) * goal(2, j);
    }
  }
  const auto& n = out.n;
  out.sine = (n[1][0] * n[1][0] + n[1][2] * n[1][2]).sqrt();
  // The middle row is (sin θ sin q6, cos θ, −sin θ cos q6), and θ has either sign.
  const Lanes side(1.0, -1.0, 1.0, -1.0);
  const Lanes scale = side * out.sine.max(kWristSine).inverse();
  out.q6 = {-n[1][2] * scale, n[1][0] * scale};
  if ((out.sine < kWristSine).any()) {  // axis 6 along axes 2, 3, 4: joint 6 stays
    const double c = std::cos(held);
    const double s = std::sin(held);
    out.q6.cosine = (out.sine < kWristSine).select(c, out.q6.cosine);
    out.q6.sine = (out.sine < kWristSine).select(s, out.q6.sine);
  }
  finish_wrist(out);
  return out;
}

void ParallelWrist::finish_wrist(WristLanes& wrist) {
  // With q6 known the others follow without loss, however small the sine: M = N Ry(−q6) =
  // Ry(S) Rx(θ), whose first column is (cos S, 0, −sin S).
  const auto& n = wrist.n;
  std::array<Lanes, 3> left;
  std::array<Lanes, 3> right;
  for (size_t i = 0; i < 3; ++i) {
    left[i] = wrist.q6.cosine * n[i][0] + wrist.q6.sine * n[i][2];
    right[i] = wrist.q6.cosine * n[i][2] - wrist.q6.sine * n[i][0];
  }
  wrist.sum = LaneTurn::along(left[0], -left[2]);
  wrist.theta = LaneTurn::along(n[1][1], -right[1]);
  // The forward kinematics of what was found against M: ‖A − B‖ = √2 · angle, for small ones.
  const auto square = [](const Lanes& value) { return value * value; };
  const LaneTurn& s = wrist.sum;
  const LaneTurn& t = wrist.theta;
  const Lanes sum = square(left[0] - s.cosine) + square(left[1]) + square(left[2] + s.sine) +
                    square(n[0][1] - s.sine * t.sine) + square(n[1][1] - t.cosine) +
                    square(n[2][1] - s.cosine * t.sine) + square(right[0] - s.sine * t.cosine) +
                    square(right[1] + t.sine) + square(right[2] - s.cosine * t.cosine);
  wrist.angle_off = (0.5 * sum).sqrt();
}

ParallelWrist::ArmLanes ParallelWrist::reach_arm(const WristLanes& wrist, const PlaceLanes& place,
                                                 double held) const {
  // Joints 2 and 3 carry axis 4 to its place, joint 4 makes up the sum.
  const LaneTurn& sum = wrist.sum;
  ArmLanes arm;
  arm.target_z = place.z - (sum.cosine * hand_.real() - sum.sine * hand_.imag());
  arm.target_x = place.x - (sum.sine * hand_.real() + sum.cosine * hand_.imag());
  arm.span = (arm.target_z * arm.target_z + arm.target_x * arm.target_x).sqrt();
  const LaneElbow elbow = bend_elbow(upper_length_, fore_length_, arm.span, Lanes::Ones());
  arm.bend = elbow.bend;
  arm.missing = elbow.missing;
  const Lanes span_z = upper_length_ + fore_length_ * arm.bend.cosine;
  const Lanes span_x = fore_length_ * arm.bend.sine;
  // The upper arm's turn carries (span_z, ±span_x) to the target.
  const Lanes zz = arm.target_z * span_z;
  const Lanes xx = arm.target_x * span_x;
  const Lanes xz = arm.target_x * span_z;
  const Lanes zx = arm.target_z * span_x;
  arm.up = LaneTurn::along(zz + xx, xz - zx);
  arm.down = LaneTurn::along(zz - xx, xz + zx);
  for (int lane = 0; lane < 4; ++lane) {
    if (arm.span[lane] >= kOnAxis) continue;  // folded: joint 2 stays
    arm.up.cosine[lane] = arm.down.cosine[lane] = std::cos(held + upper_angle_);
    arm.up.sine[lane] = arm.down.sine[lane] = std::sin(held + upper_angle_);
  }
  const auto missed = [&](const LaneTurn& turn, const Lanes& x) -> Lanes {
    const Lanes off_z = turn.cosine * span_z - turn.sine * x - arm.target_z;
    const Lanes off_x = turn.sine * span_z + turn.cosine * x - arm.target_x;
    return off_z * off_z + off_x * off_x;
  };
  arm.off_square = missed(arm.up, span_x).max(missed(arm.down, -span_x));
  return arm;
}

bool ParallelWrist::nudge_wrist(const ArmLanes& arm, WristLanes& wrist) const {
  // Near alignment the pose's rounding leaves q6 open by about rounding / sine: within that the
  // wrist turns so far that the arm reaches.
  constexpr double kRounding = 1e-14;
  bool nudged = false;
  for (int lane = 0; lane < 4; ++lane) {
    if (arm.missing[lane] <= 0.0 || wrist.sine[lane] > kRounding / kBoundary) continue;
    const Planar turn(wrist.sum.cosine[lane], wrist.sum.sine[lane]);
    const Planar target(arm.target_z[lane], arm.target_x[lane]);
    const Planar moved = Planar(0.0, -1.0) * turn * hand_;  // of the target, with the sum
    const double rate = std::real(std::conj(target) * moved) / arm.span[lane];
    const bool far = arm.span[lane] > upper_length_;
    const double shift = (far ? -1.0 : 1.0) * arm.missing[lane] / rate;
    if (!(std::abs(shift) < kRounding / std::max(wrist.sine[lane], kRounding))) continue;
    const double way = wrist.n[1][1][lane] > 0.0 ? -1.0 : 1.0;
    const Planar q6 =
        Planar(wrist.q6.cosine[lane], wrist.q6.sine[lane]) * std::polar(1.0, way * shift);
    wrist.q6.cosine[lane] = q6.real();
    wrist.q6.sine[lane] = q6.imag();
    nudged = true;
  }
  if (nudged) finish_wrist(wrist);
  return nudged;
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
