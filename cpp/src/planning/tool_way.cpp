#include "planning/tool_way.hpp"

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "viapoint/core/number_text.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint::planning {
namespace {

/// More turns than this are taken for a mistake of unit.
constexpr double kMostTurns = 1000.0;

[[noreturn]] void refuse_half_turn() {
  throw MotionError(ErrorCode::kHalfTurn,
                    "start and target orientation are 180° apart: the least rotation between "
                    "them is not unique",
                    {"add a via point that says which way to turn",
                     "orientation=\"wrist\": the wrist joints are interpolated"});
}

std::unique_ptr<const OrientationCurve> steady(const Eigen::Matrix3d& from,
                                               const Eigen::Vector3d& rate) {
  return std::make_unique<SteadyTurn>(from, rate);
}

bool ends_in_the_targets_pose(Orientation orientation) {
  return orientation == Orientation::kLeast || orientation == Orientation::kThrough ||
         orientation == Orientation::kWrist;
}

/// Through the orientations of start, via point and end.
std::unique_ptr<const OrientationCurve> turn_by_way_of(const Pose& from, const Pose& via,
                                                       const Pose& to, const HelixCurve& arc) {
  const std::vector<Eigen::Matrix3d> rotations = {from.linear(), via.linear(), to.linear()};
  const std::vector<double> at = {0.0, arc.share_at(via.translation()) * arc.length(),
                                  arc.length()};
  return std::make_unique<OrientationSpline>(OrientationSpline::through(rotations, at));
}

[[noreturn]] void refuse_joint(const RobotModel& robot, const char* what, int joint, double value) {
  const JointLimits& limits = robot.limits();
  Problem problem;
  problem.code = ErrorCode::kJointLimit;
  problem.joint = joint;
  problem.value = value;
  problem.limit =
      value > limits.position_max[joint] ? limits.position_max[joint] : limits.position_min[joint];
  problem.message = std::string(what) + ": joint " + std::to_string(joint + 1) + " is at " +
                    in_words(robot, joint, value) + "; allowed is " +
                    in_words(robot, joint, limits.position_min[joint]) + " to " +
                    in_words(robot, joint, limits.position_max[joint]);
  problem.ways_out = {"choose a value within the limits"};
  throw MotionError(std::move(problem));
}

[[noreturn]] void refuse_coupling(const char* what, int row, double value,
                                  const JointLimits& limits) {
  Problem problem;
  problem.code = ErrorCode::kCouplingLimit;
  problem.value = value;
  problem.limit =
      value > limits.coupling_upper[row] ? limits.coupling_upper[row] : limits.coupling_lower[row];
  problem.message = std::string(what) + ": coupled limit " + std::to_string(row + 1) +
                    " (row of C q) is " + number_text(value) + "; allowed is " +
                    number_text(limits.coupling_lower[row]) + " to " +
                    number_text(limits.coupling_upper[row]);
  problem.ways_out = {"choose joints that keep C q within the bounds of that row"};
  throw MotionError(std::move(problem));
}

}  // namespace

std::string in_words(const RobotModel& robot, int joint, double value) {
  const auto& chain = robot.description().chain;
  const bool turns =
      chain.empty() || chain[static_cast<size_t>(joint)].type == JointType::kRevolute;
  return turns ? rounded_text(value / kDegree) + "°" : rounded_text(value) + " m";
}

void require_within_limits(const RobotModel& robot, const JointVector& q, const char* what) {
  if (q.size() != robot.joints()) {
    throw MotionError(ErrorCode::kBadArgument,
                      std::string(what) + " has " + std::to_string(q.size()) + " values, " +
                          robot.name() + " has " + std::to_string(robot.joints()) + " joints");
  }
  if (!q.allFinite()) {
    throw MotionError(ErrorCode::kBadArgument, std::string(what) + " has a value not finite");
  }
  const JointLimits& limits = robot.limits();
  if (limits.contains(q, kNowhere)) return;
  for (int i = 0; i < robot.joints(); ++i) {
    if (q[i] < limits.position_min[i] - kNowhere || q[i] > limits.position_max[i] + kNowhere) {
      refuse_joint(robot, what, i, q[i]);
    }
  }
  for (int row = 0; row < limits.couplings(); ++row) {
    const double value = limits.coupling.row(row).dot(q);
    if (value < limits.coupling_lower[row] - kNowhere ||
        value > limits.coupling_upper[row] + kNowhere) {
      refuse_coupling(what, row, value, limits);
    }
  }
}

void require_kinematics(const RobotModel& robot) {
  if (robot.has_kinematics()) return;
  throw MotionError(ErrorCode::kUncontrolled,
                    robot.name() + " has joints but no kinematics: it cannot move on a tool curve",
                    {"use movej with joints, or spline(...) through joints"});
}

Pose pose_of(const RobotModel& robot, const Target& target, const JointVector& start) {
  if (const auto* joints = std::get_if<JointTarget>(&target)) {
    require_within_limits(robot, joints->q, "the target");
    return robot.forward().pose(joints->q);
  }
  if (const auto* pose = std::get_if<PoseTarget>(&target)) return pose->pose_base_tool;
  Pose pose = robot.forward().pose(start);
  pose.translation() = std::get<PositionTarget>(target).position;
  return pose;
}

Hold hold_of(Orientation orientation, const Target& goal) {
  if (orientation == Orientation::kWrist) return Hold::kWrist;
  if (orientation == Orientation::kFree) return Hold::kPosition;
  if (orientation == Orientation::kSpin) return Hold::kAxis;
  const bool of_the_goal =
      orientation == Orientation::kLeast || orientation == Orientation::kThrough;
  return of_the_goal && std::holds_alternative<PositionTarget>(goal) ? Hold::kPosition
                                                                     : Hold::kPose;
}

std::unique_ptr<const OrientationCurve> least_turn(const Eigen::Matrix3d& from,
                                                   const Eigen::Matrix3d& to, double length) {
  constexpr double kHalfTurnSlack = 1e-9;
  if (rotation_distance(from, to) >= kPi - kHalfTurnSlack) refuse_half_turn();
  return std::make_unique<SteadyTurn>(SteadyTurn::between(from, to, length));
}

Eigen::Matrix3d least_turned_axis(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  constexpr double kOppositeSlack = 1e-9;
  const Eigen::Vector3d across = from.col(2).cross(to.col(2));
  if (from.col(2).dot(to.col(2)) < 0.0 && across.norm() <= kOppositeSlack) refuse_half_turn();
  return Eigen::Quaterniond::FromTwoVectors(from.col(2), to.col(2)) * from;
}

ToolWay way_of(const LinMove& move, const RobotModel& robot, const JointVector& start) {
  require_kinematics(robot);
  const Pose from = robot.forward().pose(start);
  Pose to = pose_of(robot, move.target, start);
  ToolWay way;
  way.goal = move.target;
  way.hold = hold_of(move.orientation, move.target);
  way.joints_count = ends_in_the_targets_pose(move.orientation);
  if (way.hold == Hold::kAxis) to.linear() = least_turned_axis(from.linear(), to.linear());
  // The direction of a straight line is the same all along.
  const bool turns = way.hold == Hold::kAxis ||
                     (way.hold == Hold::kPose && move.orientation != Orientation::kFixed &&
                      move.orientation != Orientation::kTangent);
  const double turn = turns ? rotation_distance(from.linear(), to.linear()) : 0.0;
  if (way.hold != Hold::kWrist && (to.translation() - from.translation()).norm() < kNowhere &&
      turn < kNowhere) {
    throw MotionError(ErrorCode::kZeroLength, "the move goes nowhere: the tool is already there");
  }
  LineCurve curve =
      turns ? LineCurve(from, to) : LineCurve::fixed_orientation(from, to.translation());
  if (curve.half_turn()) refuse_half_turn();
  way.curve = std::make_unique<LineCurve>(std::move(curve));
  return way;
}

ToolWay way_of(const CircMove& move, const RobotModel& robot, const JointVector& start) {
  require_kinematics(robot);
  const Pose from = robot.forward().pose(start);
  const Pose via = pose_of(robot, move.via, start);
  const Pose to = pose_of(robot, move.target, start);
  auto arc = std::make_unique<HelixCurve>(
      HelixCurve::through(from.translation(), via.translation(), to.translation()));
  ToolWay way;
  way.goal = move.target;
  way.hold = hold_of(move.orientation, move.target);
  way.joints_count = ends_in_the_targets_pose(move.orientation);
  std::unique_ptr<const OrientationCurve> orientation;
  if (way.hold == Hold::kAxis) {
    orientation =
        least_turn(from.linear(), least_turned_axis(from.linear(), to.linear()), arc->length());
  } else if (way.hold != Hold::kPose || move.orientation == Orientation::kFixed) {
    orientation = steady(from.linear(), Eigen::Vector3d::Zero());
  } else if (move.orientation == Orientation::kTangent) {
    orientation = steady(from.linear(), arc->axis() * (arc->angle() / arc->length()));
  } else if (move.orientation == Orientation::kLeast) {
    orientation = least_turn(from.linear(), to.linear(), arc->length());
  } else if (std::holds_alternative<PositionTarget>(move.via)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "orientation=\"through\" needs a via point that has an orientation, and this "
                      "one is a position",
                      {"give the via point as a pose", "orientation=\"least\""});
  } else {
    orientation = turn_by_way_of(from, via, to, *arc);
  }
  way.curve = std::make_unique<ToolCurve>(std::move(arc), std::move(orientation));
  return way;
}

ToolWay way_of(const TurnMove& move, const RobotModel& robot, const JointVector& start) {
  require_kinematics(robot);
  if (move.orientation == Orientation::kLeast || move.orientation == Orientation::kThrough) {
    throw MotionError(ErrorCode::kBadArgument,
                      "a turn by centre, axis and angle has no target orientation to go to",
                      {"orientation=\"fixed\", \"tangent\", \"wrist\", \"spin\" or \"free\""});
  }
  if (!(std::abs(move.angle) <= kMostTurns * 2.0 * kPi)) {
    char text[120];
    std::snprintf(text, sizeof text, "the angle is %g rad; it must be within ±%g turns", move.angle,
                  kMostTurns);
    throw MotionError(ErrorCode::kBadArgument, text, {"give the angle in radians: 90 * deg"});
  }
  const Pose from = robot.forward().pose(start);
  const Eigen::Vector3d center = move.center.value_or(from.translation());
  const Eigen::Vector3d axis = move.axis.value_or(from.linear().col(2));
  auto helix =
      std::make_unique<HelixCurve>(from.translation(), center, axis, move.angle, move.pitch);
  const double length = helix->length();
  const bool turns_along = move.orientation == Orientation::kTangent && length > 0.0;
  const Eigen::Vector3d rate = turns_along ? Eigen::Vector3d(helix->axis() * (move.angle / length))
                                           : Eigen::Vector3d::Zero();
  if (length < kNowhere || (!turns_along && helix->radius() < kNowhere && move.pitch == 0.0)) {
    throw MotionError(ErrorCode::kZeroLength, "the turn goes nowhere: the tool stays as it is");
  }
  ToolWay way;
  way.hold = hold_of(move.orientation, PoseTarget{from});
  Pose to = from;
  to.translation() = helix->at(length).p;
  to.linear() = rotation_exp(rate * length) * from.linear();
  if (way.hold == Hold::kPose) {
    way.goal = PoseTarget{to};
  } else {
    way.goal = PositionTarget{to.translation()};
  }
  way.curve = std::make_unique<ToolCurve>(std::move(helix), steady(from.linear(), rate));
  return way;
}

}  // namespace viapoint::planning
