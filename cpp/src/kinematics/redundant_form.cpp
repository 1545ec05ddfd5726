#include "kinematics/redundant_form.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// Where all these axes meet, if they do.
std::optional<Eigen::Vector3d> meeting_of(std::span<const Screw> joints) {
  auto point = nearest_point(joints[0].origin, joints[0].axis, joints[1].origin, joints[1].axis);
  if (!point) return std::nullopt;
  for (const Screw& joint : joints) {
    if (joint.type != JointType::kRevolute) return std::nullopt;
    if (joint.axis.cross(*point - joint.origin).norm() > kExactAxes) return std::nullopt;
  }
  return point;
}

/// Right-handed: first column along `along`, second the part of `normal` square to it.
Eigen::Matrix3d frame_of(const Eigen::Vector3d& along, const Eigen::Vector3d& normal) {
  Eigen::Matrix3d frame;
  frame.col(0) = along.normalized();
  frame.col(1) = (normal - frame.col(0).dot(normal) * frame.col(0)).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

/// The sides of the branch that is q.
ArmSides sides_by_solving(const RedundantForm& form, const Pose& pose, const JointVector& q) {
  ClosedSolutions found;
  form.solve(pose, form.parameter_of(q), q, found);
  ArmSides sides;
  double nearest = 1e300;
  for (const ClosedBranch& branch : found.branches) {
    double apart = 0.0;
    for (int i = 0; i < q.size(); ++i) {
      apart = std::max(apart, std::abs(std::remainder(branch.q[i] - q[i], 2.0 * kPi)));
    }
    if (apart >= nearest) continue;
    nearest = apart;
    sides = branch.sides;
  }
  return sides;
}

}  // namespace

std::optional<ArmAngleForm> ArmAngleForm::recognise(const ForwardKinematics& forward) {
  if (forward.joints() != 7) return std::nullopt;
  ArmAngleForm arm;
  arm.joints_ = screws_of(forward);
  const std::span<const Screw> joints(arm.joints_);
  const auto shoulder = meeting_of(joints.first(3));
  const auto wrist = meeting_of(joints.last(3));
  if (!shoulder || !wrist || joints[3].type != JointType::kRevolute) return std::nullopt;
  arm.upper_ = OrientationProblem::plan(joints.first(3));
  arm.lower_ = OrientationProblem::plan(joints.last(3));
  if (!arm.upper_ || !arm.lower_) return std::nullopt;
  arm.shoulder_ = *shoulder;
  arm.wrist_ = *wrist;
  // The elbow has to change the distance from shoulder to wrist, and its axis to tell the plane.
  arm.bend_ = Track::of(joints[3], *wrist);
  arm.square_ = JointTerm::square(arm.bend_, *shoulder);
  if (arm.square_.weight() < 1e-6) return std::nullopt;
  if (std::abs(joints[3].axis.dot(*wrist - *shoulder)) > kExactAxes) return std::nullopt;
  arm.tool_inverse_ = forward.pose(JointVector::Zero(7)).inverse(Eigen::Isometry);
  return arm;
}

std::string ArmAngleForm::family() const {
  return "closed form, seven joints: axes 1, 2, 3 meet in the shoulder and 5, 6, 7 in the wrist; "
         "parameter: arm angle";
}

Eigen::Vector3d ArmAngleForm::reference_normal(const Eigen::Vector3d& along) const {
  const Eigen::Vector3d& vertical = joints_[0].axis;
  const Eigen::Vector3d normal = vertical.cross(along.normalized());
  return normal.norm() < 1e-9 ? vertical.unitOrthogonal() : normal.normalized();
}

double ArmAngleForm::parameter_of(const JointVector& q) const {
  Eigen::Vector3d wrist = joints_[3].motion(q[3]) * wrist_;
  Eigen::Vector3d normal = joints_[3].axis;
  for (int i = 2; i >= 0; --i) {
    const Pose motion = joints_[static_cast<size_t>(i)].motion(q[i]);
    wrist = motion * wrist;
    normal = motion.linear() * normal;
  }
  const Eigen::Vector3d along = (wrist - shoulder_).normalized();
  return angle_about(along, reference_normal(along), normal);
}

void ArmAngleForm::solve(const Pose& pose_base_tool, double parameter, const JointVector& held,
                         ClosedSolutions& solutions, const JointSieve& sieve) const {
  const Pose motion = pose_base_tool * tool_inverse_;
  const Eigen::Vector3d along = motion * wrist_ - shoulder_;
  const double distance = along.norm();
  const Roots elbows = square_.solve(distance * distance, 2.0 * kBoundary * distance, 0.0);
  if (elbows.count == 0) {
    const bool far = distance * distance > square_.constant;
    const double reached = distance * distance + (far ? -elbows.missing : elbows.missing);
    solutions.out_of_reach = std::abs(distance - std::sqrt(std::max(0.0, reached)));
    return;
  }
  if (distance < kOnAxis) return;
  const Eigen::Vector3d normal =
      Eigen::AngleAxisd(parameter, along / distance) * reference_normal(along);
  const Eigen::Matrix3d target = frame_of(along, normal);
  const std::span<const double> all(held.data(), 7);
  for (int e = 0; e < elbows.count; ++e) {
    const double q4 = elbows.q[static_cast<size_t>(e)];
    const double bent = sieve.square(3, q4);
    if (!sieve.passes(bent)) continue;
    const Eigen::Matrix3d shoulder =
        target * frame_of(bend_.at(q4) - shoulder_, joints_[3].axis).transpose();
    OrientationRoots uppers;
    upper_->solve(shoulder, all.first(3), uppers);
    std::array<double, 2> squares{};
    bool any = false;
    for (int u = 0; u < uppers.count; ++u) {
      const auto k = static_cast<size_t>(u);
      squares[k] = bent + sieve.squares(0, uppers.roots[k].q);
      any = any || sieve.passes(squares[k]);
    }
    if (!any) continue;
    OrientationRoots lowers;
    lower_->solve(joints_[3].rotation(-q4) * shoulder.transpose() * motion.linear(), all.last(3),
                  lowers);
    std::array<double, 2> turned{};  // where the wrist is free its joints may be shared out
    for (int l = 0; l < lowers.count; ++l) {
      const OrientationRoot& lower = lowers.roots[static_cast<size_t>(l)];
      if (!lower.free) turned[static_cast<size_t>(l)] = sieve.squares(4, lower.q);
    }
    for (int u = 0; u < uppers.count; ++u) {
      if (!sieve.passes(squares[static_cast<size_t>(u)])) continue;
      const OrientationRoot& upper = uppers.roots[static_cast<size_t>(u)];
      solutions.held = solutions.held || upper.free;
      for (int l = 0; l < lowers.count; ++l) {
        const OrientationRoot& lower = lowers.roots[static_cast<size_t>(l)];
        const double whole = squares[static_cast<size_t>(u)] + turned[static_cast<size_t>(l)];
        if (!sieve.passes(whole)) continue;
        ClosedBranch& branch = solutions.branches.add();
        branch.q.resize(7);
        branch.q << upper.q[0], upper.q[1], upper.q[2], q4, lower.q[0], lower.q[1], lower.q[2];
        branch.sides = ArmSides();
        branch.sides.shoulder = upper.side;
        branch.sides.elbow = e == 0 ? elbows.apart : -elbows.apart;
        branch.sides.wrist = lower.side;
        branch.wrist_free = lower.free;
        branch.first = 4;
        branch.second = 6;
        branch.wrist_sign = lower.sign;
        branch.wrist_sum = lower.q[0] + lower.sign * lower.q[2];
      }
    }
  }
}

ArmSides ArmAngleForm::sides(const JointVector& q) const {
  Pose motion = Pose::Identity();
  for (int i = 0; i < 7; ++i) motion = motion * joints_[static_cast<size_t>(i)].motion(q[i]);
  return sides_by_solving(*this, motion * tool_inverse_.inverse(Eigen::Isometry), q);
}

std::pair<double, double> ArmAngleForm::range(const JointLimits&) const { return {-kPi, kPi}; }

LastJointForm::LastJointForm(ForwardKinematics forward, Decomposition decomposition)
    : forward_(std::move(forward)),
      decomposition_(std::move(decomposition)),
      last_(screws_of(forward_).back()),
      tool_inverse_(forward_.pose(JointVector::Zero(7)).inverse(Eigen::Isometry)) {}

std::optional<LastJointForm> LastJointForm::recognise(const ForwardKinematics& forward) {
  if (forward.joints() != 7 || forward.type(6) != JointType::kRevolute) return std::nullopt;
  const std::vector<Screw> joints = screws_of(forward);
  const Pose zero = forward.pose(JointVector::Zero(7));
  auto decomposition = Decomposition::find(std::span(joints).first(6), zero.translation());
  if (!decomposition) return std::nullopt;
  return LastJointForm(forward, *std::move(decomposition));
}

std::string LastJointForm::family() const {
  return "closed form, seven joints: with joint 7 as the parameter, " + decomposition_.describe();
}

void LastJointForm::solve(const Pose& pose_base_tool, double parameter, const JointVector& held,
                          ClosedSolutions& solutions, const JointSieve& sieve) const {
  const double turned = sieve.square(6, parameter);
  if (!sieve.passes(turned)) return;
  const Pose motion = pose_base_tool * tool_inverse_ * last_.motion(-parameter);
  decomposition_.solve(motion, held, solutions, sieve, turned);
  for (ClosedBranch& branch : solutions.branches) {
    branch.q.conservativeResize(7);
    branch.q[6] = parameter;
  }
}

ArmSides LastJointForm::sides(const JointVector& q) const {
  return sides_by_solving(*this, forward_.pose(q), q);
}

std::pair<double, double> LastJointForm::range(const JointLimits& limits) const {
  const double low = limits.position_min[6];
  const double high = limits.position_max[6];
  if (!(high - low < 2.0 * kPi)) return {-kPi, kPi};  // every angle, on some turn
  return {low, high};
}

std::unique_ptr<const RedundantForm> recognise_redundant_form(const ForwardKinematics& forward) {
  if (auto arm = ArmAngleForm::recognise(forward)) {
    return std::make_unique<ArmAngleForm>(*std::move(arm));
  }
  if (auto arm = LastJointForm::recognise(forward)) {
    return std::make_unique<LastJointForm>(*std::move(arm));
  }
  return nullptr;
}

}  // namespace viapoint
