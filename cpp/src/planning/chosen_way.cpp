#include "planning/chosen_way.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/tool_way.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/kinematics/pose_path.hpp"
#include "viapoint/path/joint_guide.hpp"

namespace viapoint::planning {
namespace {

/// How closely a curve is looked at.
struct Look {
  int fewest;             ///< steps
  double longest;         ///< step [m, or rad of a turn on the spot]
  double largest_change;  ///< of a joint in a step [rad or m]
};
/// The second where the way between the places of the first cannot be followed, as in a quick turn
/// of the wrist. (Of 600 lines none had a way through the second's places and not the first's.)
constexpr Look kLooks[] = {{32, 0.03, 0.7}, {200, 0.005, kLargestStep}};
constexpr int kMostSteps = 400;

int steps_of(const Look& look, double length) {
  const double steps = std::min(std::ceil(length / look.longest), 1.0 * kMostSteps);
  return std::max(look.fewest, static_cast<int>(steps));
}

std::vector<Pose> poses_of(const TaskCurve& curve, int steps) {
  std::vector<Pose> poses(static_cast<size_t>(steps) + 1);
  for (int k = 0; k <= steps; ++k) {
    const CurvePoint at = curve.at(curve.length() * k / steps);
    Pose& pose = poses[static_cast<size_t>(k)];
    pose.setIdentity();
    pose.linear() = at.rotation;
    pose.translation() = at.p;
  }
  return poses;
}

bool arrives(const Insertion& found, const JointVector& goal) {
  return (found.knots.back() - goal).cwiseAbs().maxCoeff() <= kSameBranch;
}

}  // namespace

bool leaves_one_open(const RobotModel& robot, Hold hold) {
  return hold == Hold::kPose && robot.joints() == 7 && !robot.inverse().redundancy().empty();
}

std::optional<Insertion> insert_with_choice(const RobotModel& robot, const TaskCurve& curve,
                                            const JointVector& start, const JointVector* goal,
                                            const InsertionOptions& how) {
  // What the caller tried first says better what stands in the way than these refusals.
  for (const Look& look : kLooks) {
    std::vector<JointVector> way;
    try {
      way = follow_poses(robot, poses_of(curve, steps_of(look, curve.length())), start,
                         look.largest_change, goal);
    } catch (const MotionError&) {
      return std::nullopt;
    }
    way.front() = start;
    const JointGuide guide =
        smooth_guide(robot.forward(), robot.limits(), curve, way, goal != nullptr, how);
    InsertionOptions guided = how;
    guided.guide = &guide;
    try {
      Insertion found = insert_curve(robot.forward(), robot.limits(), curve, start, guided);
      if (goal == nullptr || arrives(found, *goal)) return found;
    } catch (const MotionError&) {
      continue;
    }
  }
  return std::nullopt;
}

}  // namespace viapoint::planning
