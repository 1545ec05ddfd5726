#include "planning/timed_points.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint::planning {
namespace {

void require_joints(const RobotModel& robot, const JointVector& q, const std::string& what) {
  if (q.size() != robot.joints()) {
    throw MotionError(ErrorCode::kBadArgument, what + " has " + std::to_string(q.size()) +
                                                   " values, " + robot.name() + " has " +
                                                   std::to_string(robot.joints()) + " joints");
  }
  if (!q.allFinite()) throw MotionError(ErrorCode::kBadArgument, what + " has a value not finite");
}

/// The same error, saying which point it is about.
[[noreturn]] void rethrow_for(size_t point, const MotionError& error) {
  Problem problem = error.problem();
  problem.message = "point " + std::to_string(point) + ": " + problem.message;
  throw MotionError(std::move(problem));
}

void require_kinematics(const RobotModel& robot) {
  if (robot.has_kinematics()) return;
  throw MotionError(ErrorCode::kUncontrolled,
                    robot.name() + " has joints only and no kinematics: it has no tool to move",
                    {"give joint values, with space=\"joint\"", "use a robot with kinematics"});
}

JointVector joints_at(const RobotModel& robot, const Target& target, const JointVector& near) {
  if (const auto* joints = std::get_if<JointTarget>(&target)) {
    require_joints(robot, joints->q, "the target");
    return joints->q;
  }
  require_kinematics(robot);
  if (const auto* pose = std::get_if<PoseTarget>(&target)) {
    return robot.inverse().solve_near_unlimited(pose->pose_base_tool, near);
  }
  return robot.inverse().solve_near(std::get<PositionTarget>(target).position, near);
}

}  // namespace

std::vector<double> durations_of(const TimedMove& move) {
  if (move.points.size() < 2) {
    throw MotionError(
        ErrorCode::kBadArgument,
        "a timed motion has " + std::to_string(move.points.size()) + " points; it needs at least 2",
        {"add the points it goes through"});
  }
  if (move.points.front().seconds != 0.0) {
    Problem problem;
    problem.code = ErrorCode::kBadArgument;
    problem.message = "the first point of a timed motion has " +
                      std::to_string(move.points.front().seconds) +
                      " s; the motion begins there, so it must have 0 s";
    problem.value = move.points.front().seconds;
    problem.limit = 0.0;
    throw MotionError(std::move(problem));
  }
  std::vector<double> durations;
  for (size_t i = 1; i < move.points.size(); ++i) durations.push_back(move.points[i].seconds);
  return durations;
}

std::vector<JointVector> joints_of(const RobotModel& robot, const JointVector& start,
                                   const TimedMove& move) {
  require_joints(robot, start, "the program's start");
  std::vector<JointVector> joints;
  for (size_t i = 0; i < move.points.size(); ++i) {
    try {
      joints.push_back(
          joints_at(robot, move.points[i].target, joints.empty() ? start : joints.back()));
    } catch (const MotionError& error) {
      rethrow_for(i, error);
    }
  }
  return joints;
}

ToolPoints tool_points_of(const RobotModel& robot, const JointVector& start,
                          const TimedMove& move) {
  require_kinematics(robot);
  require_joints(robot, start, "the program's start");
  ToolPoints points;
  points.oriented =
      std::any_of(move.points.begin(), move.points.end(), [](const TimedPoint& point) {
        return !std::holds_alternative<PositionTarget>(point.target);
      });
  JointVector near = start;
  for (size_t i = 0; i < move.points.size(); ++i) {
    const Target& target = move.points[i].target;
    try {
      // Later poses need no joints of their own: they are reached along the motion, or not.
      const auto* pose = std::get_if<PoseTarget>(&target);
      const auto* position = std::get_if<PositionTarget>(&target);
      if (pose != nullptr && i > 0) {
        points.poses.push_back(pose->pose_base_tool);
      } else if (position != nullptr && !points.oriented && i > 0) {
        points.poses.push_back(Pose(Eigen::Translation3d(position->position)));
      } else {
        near = joints_at(robot, target, near);
        points.poses.push_back(points.oriented ? robot.forward().pose(near)
                                               : Pose(Eigen::Translation3d(position->position)));
        if (pose != nullptr) points.poses.back() = pose->pose_base_tool;
      }
    } catch (const MotionError& error) {
      rethrow_for(i, error);
    }
    if (i == 0) points.first = near;
  }
  return points;
}

}  // namespace viapoint::planning
