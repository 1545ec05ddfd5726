/// @file
/// One move as geometry, before corners and time.
#pragma once

#include <variant>
#include <vector>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::planning {

/// A point in the space in which the legs are straight, and the tool's orientation where it counts.
struct MergedPlace {
  JointVector at;  ///< joints (n,), or the tool point (3,) [m]
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// What a leg that was made of several deviates from them by, both ways.
struct MergedLegs {
  std::vector<CornerOutcome> points;  ///< what became of the points between them
  std::vector<MergedPlace> places;    ///< where these are as they were told
  double distance = 0.0;              ///< [m], in joint space [rad or m, 2-norm]
  double turn = 0.0;                  ///< of the tool [rad]
  double at_tool = 0.0;               ///< a bound of the distance there [m]
};

/// The whole way of one move, from point to point.
struct Leg {
  RobotPtr robot;     ///< the arm with the tool that moves here
  int step = 0;       ///< in the program
  JointVector start;  ///< (n,)
  JointVector goal;   ///< (n,)
  JointPath path;     ///< from start to goal; pieces carry scale, speed wishes and step
  MoveOptions options;
  bool cartesian = false;
  std::variant<std::monostate, PtpMove, LinMove> straight;  ///< the move, where it is a line
  MergedLegs merged;
  /// What the program allows the tool; of no meaning in joint space.
  [[nodiscard]] ToolLimits tool_limits() const {
    ToolLimits limits;
    if (!cartesian) return limits;
    limits.speed = options.process_speed.value_or(options.speed.value_or(ToolLimits::kNone));
    limits.hold_speed = options.process_speed.has_value();
    limits.acceleration = options.acceleration.value_or(ToolLimits::kNone);
    limits.angular_speed = options.angular_speed.value_or(ToolLimits::kNone);
    limits.angular_acceleration = options.angular_acceleration.value_or(ToolLimits::kNone);
    return limits;
  }

  double position_deviation = 0.0;  ///< proven, from the wanted curve [m]
  double angle_deviation = 0.0;     ///< [rad]
};

}  // namespace viapoint::planning
