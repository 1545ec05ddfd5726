#include "viapoint/kinematics/workspace.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

constexpr double kEndTolerance = 1e-9;  ///< [m]

/// Asks the inverse whether the tool can be at a place of the ray.
class Ray {
 public:
  Ray(const RobotModel& robot, const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
      const std::optional<Eigen::Matrix3d>& rotation)
      : inverse_(robot.inverse()),
        start_(start),
        direction_(direction),
        rotation_(rotation),
        near_(JointVector::Zero(robot.joints())) {}

  [[nodiscard]] bool holds(double s) {
    const Eigen::Vector3d point = start_ + s * direction_;
    try {
      if (rotation_) {
        Pose pose = Pose::Identity();
        pose.linear() = *rotation_;
        pose.translation() = point;
        near_ = inverse_.solve_near(pose, near_);
      } else {
        near_ = inverse_.solve_near(point, near_);
      }
    } catch (const MotionError& error) {
      const ErrorCode code = error.code();
      if (code == ErrorCode::kUnreachable || code == ErrorCode::kOutsideLimits ||
          code == ErrorCode::kUncontrolled) {
        return false;
      }
      throw;
    }
    return true;
  }

  /// Where between `inside` and `outside` the tool stops being able to be.
  [[nodiscard]] double end_between(double inside, double outside) {
    while (std::abs(outside - inside) > kEndTolerance) {
      const double middle = 0.5 * (inside + outside);
      (holds(middle) ? inside : outside) = middle;
    }
    return inside;
  }

 private:
  const InverseKinematics& inverse_;
  Eigen::Vector3d start_;
  Eigen::Vector3d direction_;
  std::optional<Eigen::Matrix3d> rotation_;
  JointVector near_;
};

/// No joint vector brings the tool farther than this from the first axis, or along it [m].
double farthest(const RobotModel& robot) {
  const JointVector zero = JointVector::Zero(robot.joints());
  double slides = 0.0;
  for (int i = 0; i < robot.joints(); ++i) {
    if (robot.forward().type(i) != JointType::kPrismatic) continue;
    const double most = std::max(std::abs(robot.limits().position_min[i]),
                                 std::abs(robot.limits().position_max[i]));
    if (!std::isfinite(most)) {
      throw MotionError(ErrorCode::kBadArgument,
                        "joint " + std::to_string(i + 1) +
                            " slides without a limit, so there is no farthest point",
                        {"give the joint position limits: with_limits(position_min=..., "
                         "position_max=...)"});
    }
    slides += most;
  }
  const ChainFrames frames = robot.forward().frames(zero);
  double length = frames.origin[0].norm() + slides;
  for (int i = 1; i < robot.joints(); ++i) {
    const auto k = static_cast<size_t>(i);
    length += (frames.origin[k] - frames.origin[k - 1]).norm();
  }
  const auto last = static_cast<size_t>(robot.joints() - 1);
  return length + (frames.pose_base_tool.translation() - frames.origin[last]).norm();
}

}  // namespace

std::vector<Stretch> reach(const RobotModel& robot, const Eigen::Vector3d& start,
                           const Eigen::Vector3d& direction,
                           const std::optional<Eigen::Matrix3d>& rotation) {
  if (!robot.has_kinematics()) {
    throw MotionError(ErrorCode::kUncontrolled,
                      "robot \"" + robot.name() + "\" has joints and limits but no kinematics",
                      {"load a robot with a D-H table or a URDF"});
  }
  if (!start.allFinite() || !direction.allFinite() || !(direction.norm() > 1e-12)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "reach needs a finite start, and a direction that is not zero");
  }
  Ray ray(robot, start, direction.normalized(), rotation);
  const double most = start.norm() + farthest(robot);
  const double step = most / kReachSteps;
  std::vector<Stretch> stretches;
  bool before = false;
  for (int i = 0; i <= kReachSteps + 1; ++i) {
    const double s = step * i;
    const bool here = ray.holds(s);
    if (here && !before) stretches.push_back({i == 0 ? 0.0 : ray.end_between(s, s - step), s});
    if (here) stretches.back().to = s;
    if (!here && before) stretches.back().to = ray.end_between(s - step, s);
    before = here;
  }
  return stretches;
}

}  // namespace viapoint
