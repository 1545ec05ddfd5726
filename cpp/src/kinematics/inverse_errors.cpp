#include "kinematics/inverse_errors.hpp"

#include <cmath>

#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// Largest element of RᵀR − I; not a number where the pose has one.
double off_rotation(const Pose& pose) {
  const Eigen::Matrix3d r = pose.linear();
  return (r.transpose() * r - Eigen::Matrix3d::Identity())
      .cwiseAbs()
      .maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace

PoseError pose_error(const Pose& a, const Pose& b) {
  PoseError error;
  error.position = (a.translation() - b.translation()).norm();
  // ‖A − B‖ = 2√2 sin(θ/2): exact for small angles, where the trace is blind.
  const double chord = (a.linear() - b.linear()).norm() / (2.0 * std::sqrt(2.0));
  error.angle = 2.0 * std::asin(std::min(1.0, chord));
  return error;
}

bool is_pose(const Pose& pose) {
  const auto r = pose.linear();
  const Eigen::Vector3d x = r.col(0);
  const Eigen::Vector3d y = r.col(1);
  const Eigen::Vector3d z = r.col(2);
  const auto near = [](double value) { return std::abs(value) <= kPoseTolerance; };  // NaN is not
  const bool unit = near(x.dot(x) - 1.0) & near(y.dot(y) - 1.0) & near(z.dot(z) - 1.0);
  const bool square = near(x.dot(y)) & near(y.dot(z)) & near(z.dot(x));
  return unit && square && z.dot(x.cross(y)) > 0.0 && pose.translation().allFinite();
}

void require_pose(const Pose& pose) {
  if (is_pose(pose)) return;
  if (!pose.matrix().allFinite()) {
    throw MotionError(ErrorCode::kBadArgument, "the pose has an element that is not finite");
  }
  const double off = off_rotation(pose);
  Problem problem;
  problem.code = ErrorCode::kNotARotation;
  problem.message =
      "the 3x3 block of the pose is not a rotation: its columns are off unit length or right "
      "angles by " +
      number_text(off);
  problem.value = off;
  problem.limit = kPoseTolerance;
  problem.ways_out = {"pass the matrix through checked_pose, which projects what is only rounded"};
  throw MotionError(std::move(problem));
}

void require_position(const Eigen::Vector3d& position) {
  if (position.allFinite()) return;
  throw MotionError(ErrorCode::kBadArgument, "the position has an element that is not finite");
}

void require_joints(const JointVector& q, int joints, const char* what) {
  if (q.size() != joints) {
    throw MotionError(ErrorCode::kBadArgument,
                      std::string(what) + " has " + std::to_string(q.size()) +
                          " values, the arm has " + std::to_string(joints) + " joints");
  }
  for (int i = 0; i < joints; ++i) {
    if (std::isfinite(q[i])) continue;
    Problem problem;
    problem.code = ErrorCode::kBadArgument;
    problem.message =
        std::string(what) + ": joint " + std::to_string(i + 1) + " is not a finite number";
    problem.joint = i;
    problem.value = q[i];
    throw MotionError(std::move(problem));
  }
}

std::string joint_value(JointType type, double value) {
  return type == JointType::kRevolute ? rounded_text(value / kDegree) + "°"
                                      : rounded_text(value) + " m";
}

void refuse_outside_limits(const ForwardKinematics& forward, const JointTurns& turns,
                           const std::vector<JointVector>& branches) {
  LimitExcess least;
  for (const JointVector& branch : branches) {
    const LimitExcess excess = turns.excess(branch);
    if (least.excess == 0.0 || excess.excess < least.excess) least = excess;
  }
  Problem problem;
  problem.code = ErrorCode::kOutsideLimits;
  problem.value = least.value;
  problem.limit = least.limit;
  problem.message = "the pose is within reach, but on no branch (" +
                    std::to_string(branches.size()) + " found) within the joint limits; nearest: ";
  if (least.joint >= 0) {
    const JointType type = forward.type(least.joint);
    problem.joint = least.joint;
    problem.message += "joint " + std::to_string(least.joint + 1) + " at " +
                       joint_value(type, least.value) + ", its limit is " +
                       joint_value(type, least.limit);
  } else if (least.row < 0) {
    problem.message += "a joint on its limit, where the pose is missed by more than rounding";
  } else {
    problem.message += "coupled limit " + std::to_string(least.row + 1) + " at " +
                       number_text(least.value) + ", its bound is " + number_text(least.limit);
  }
  problem.ways_out = {"move or turn the pose", "widen that limit, if the arm allows it"};
  throw MotionError(std::move(problem));
}

void refuse_unreachable(const std::string& what, double distance) {
  Problem problem;
  problem.code = ErrorCode::kUnreachable;
  problem.message = what + ": " + joint_value(JointType::kPrismatic, distance) + " out of reach";
  problem.value = distance;
  problem.limit = 0.0;
  problem.ways_out = {"move the pose towards the arm's working range by at least that much"};
  throw MotionError(std::move(problem));
}

}  // namespace viapoint
