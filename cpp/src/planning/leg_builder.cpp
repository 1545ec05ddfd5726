#include "planning/leg_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "planning/tool_limits.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/task_curve.hpp"

namespace viapoint::planning {
namespace {

/// Below this a move goes nowhere [rad or m].
constexpr double kNowhere = 1e-9;
/// How near a straight line must come to the joints it was asked for [rad or m].
constexpr double kSameBranch = 1e-3;

std::string in_words(const RobotModel& robot, int joint, double value) {
  char text[64];
  if (robot.description().chain.empty() ||
      robot.description().chain[static_cast<size_t>(joint)].type == JointType::kRevolute) {
    std::snprintf(text, sizeof text, "%.2f°", value / kDegree);
  } else {
    std::snprintf(text, sizeof text, "%.4f m", value);
  }
  return text;
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
                    " (row of C q) is " + std::to_string(value) + "; allowed is " +
                    std::to_string(limits.coupling_lower[row]) + " to " +
                    std::to_string(limits.coupling_upper[row]);
  throw MotionError(std::move(problem));
}

}  // namespace

void LegBuilder::require_within_limits(const JointVector& q, const char* what) const {
  if (q.size() != robot_.joints()) {
    throw MotionError(ErrorCode::kBadArgument,
                      std::string(what) + " has " + std::to_string(q.size()) + " values, " +
                          robot_.name() + " has " + std::to_string(robot_.joints()) + " joints");
  }
  if (!q.allFinite()) {
    throw MotionError(ErrorCode::kBadArgument, std::string(what) + " has a value not finite");
  }
  const JointLimits& limits = robot_.limits();
  if (limits.contains(q, kNowhere)) return;
  for (int i = 0; i < robot_.joints(); ++i) {
    if (q[i] < limits.position_min[i] - kNowhere || q[i] > limits.position_max[i] + kNowhere) {
      refuse_joint(robot_, what, i, q[i]);
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

JointVector LegBuilder::resolve(const Target& target, const JointVector& near) const {
  if (const auto* joints = std::get_if<JointTarget>(&target)) {
    require_within_limits(joints->q, "the target");
    return joints->q;
  }
  if (!robot_.has_kinematics()) {
    throw MotionError(ErrorCode::kUncontrolled,
                      robot_.name() + " has joints but no kinematics: a pose means nothing to it",
                      {"give the target as joints"});
  }
  if (const auto* pose = std::get_if<PoseTarget>(&target)) {
    return robot_.inverse().solve_near(pose->pose_base_tool, near);
  }
  return robot_.inverse().solve_near(std::get<PositionTarget>(target).position, near);
}

Leg LegBuilder::ptp(const PtpMove& move, const JointVector& start) const {
  Leg leg;
  leg.start = start;
  leg.goal = resolve(move.target, start);
  const double length = (leg.goal - leg.start).norm();
  if (length < kNowhere) {
    throw MotionError(ErrorCode::kZeroLength, "the move goes nowhere: the arm is already there");
  }
  leg.path.append(JointPiece::line(leg.start, leg.goal, length));
  return leg;
}

Pose LegBuilder::pose_of(const Target& target, const JointVector& start) const {
  if (const auto* joints = std::get_if<JointTarget>(&target)) {
    require_within_limits(joints->q, "the target");
    return robot_.forward().pose(joints->q);
  }
  if (const auto* pose = std::get_if<PoseTarget>(&target)) return pose->pose_base_tool;
  Pose pose = robot_.forward().pose(start);
  pose.translation() = std::get<PositionTarget>(target).position;
  return pose;
}

Leg LegBuilder::follow(const TaskCurve& curve, const JointVector& start,
                       const InsertionOptions& how) const {
  Insertion inserted = insert_curve(robot_.forward(), robot_.limits(), curve, start, how);
  Leg leg;
  leg.start = start;
  leg.goal = inserted.knots.back();
  leg.cartesian = true;
  leg.position_deviation = inserted.position_deviation;
  leg.angle_deviation = inserted.angle_deviation;
  for (JointPiece& piece : inserted.pieces) leg.path.append(std::move(piece));
  return leg;
}

Leg LegBuilder::lin(const LinMove& move, const JointVector& start) const {
  if (!robot_.has_kinematics()) {
    throw MotionError(ErrorCode::kUncontrolled,
                      robot_.name() + " has joints but no kinematics: it cannot move on a line",
                      {"use movej with joints"});
  }
  if (move.orientation == Orientation::kWrist) return lin_by_wrist(move.target, start);

  const bool free_orientation = std::holds_alternative<PositionTarget>(move.target) &&
                                move.orientation == Orientation::kLeast;
  const Pose from = robot_.forward().pose(start);
  const Pose to = pose_of(move.target, start);
  const bool fixed = move.orientation == Orientation::kFixed || free_orientation;
  const double turn = fixed ? 0.0 : rotation_distance(from.linear(), to.linear());
  if ((to.translation() - from.translation()).norm() < kNowhere && turn < kNowhere) {
    throw MotionError(ErrorCode::kZeroLength, "the move goes nowhere: the tool is already there");
  }
  const LineCurve curve =
      fixed ? LineCurve::fixed_orientation(from, to.translation()) : LineCurve(from, to);
  if (curve.half_turn()) {
    throw MotionError(ErrorCode::kHalfTurn,
                      "start and target orientation are 180° apart: the least rotation between "
                      "them is not unique",
                      {"add a via point that says which way to turn",
                       "orientation=\"wrist\": the wrist joints are interpolated"});
  }
  InsertionOptions how;
  how.position_tolerance = tolerance_.position;
  how.angle_tolerance = tolerance_.angle;
  how.hold = free_orientation ? Hold::kPosition : Hold::kPose;
  Leg leg = follow(curve, start, how);
  require_arrival(move, leg);
  return leg;
}

void LegBuilder::require_arrival(const LinMove& move, const Leg& leg) const {
  const auto* joints = std::get_if<JointTarget>(&move.target);
  if (joints == nullptr || move.orientation == Orientation::kFixed) return;
  const JointVector miss = (joints->q - leg.goal).cwiseAbs();
  int worst = 0;
  if (miss.maxCoeff(&worst) <= kSameBranch) return;
  Problem problem;
  problem.code = ErrorCode::kBranchChange;
  problem.joint = worst;
  problem.value = leg.goal[worst];
  problem.limit = joints->q[worst];
  problem.share = 1.0;
  problem.message = "the straight line reaches the target's pose on another branch: joint " +
                    std::to_string(worst + 1) + " arrives at " +
                    in_words(robot_, worst, leg.goal[worst]) + ", the target has " +
                    in_words(robot_, worst, joints->q[worst]);
  throw MotionError(std::move(problem));
}

Leg LegBuilder::lin_by_wrist(const Target& target, const JointVector& start) const {
  if (robot_.joints() <= 3) {
    throw MotionError(ErrorCode::kUncontrolled,
                      "orientation=\"wrist\" needs wrist joints beyond the first three; " +
                          robot_.name() + " has " + std::to_string(robot_.joints()) + " joints",
                      {"movel(position=...)", "movej"});
  }
  // Each branch of the target is a possible end: the nearest by its wrist joints that the first
  // three joints really lead to.
  std::vector<JointVector> ends;
  if (const auto* joints = std::get_if<JointTarget>(&target)) {
    require_within_limits(joints->q, "the target");
    ends = {joints->q};
  } else if (const auto* pose = std::get_if<PoseTarget>(&target)) {
    ends = robot_.inverse().solve_all(pose->pose_base_tool);
    std::sort(ends.begin(), ends.end(), [&](const JointVector& a, const JointVector& b) {
      const Eigen::Index wrist = robot_.joints() - 3;
      return (a - start).tail(wrist).cwiseAbs().maxCoeff() <
             (b - start).tail(wrist).cwiseAbs().maxCoeff();
    });
  } else {
    JointVector end = resolve(target, start);
    end.tail(robot_.joints() - 3) = start.tail(robot_.joints() - 3);
    ends = {end};
  }

  const Eigen::Vector3d goal = pose_of(target, start).translation();
  const LineCurve curve = LineCurve::fixed_orientation(robot_.forward().pose(start), goal);
  if ((goal - robot_.forward().pose(start).translation()).norm() < kNowhere) {
    if ((ends.front() - start).cwiseAbs().maxCoeff() < kNowhere) {
      throw MotionError(ErrorCode::kZeroLength, "the move goes nowhere: the tool is already there");
    }
    throw MotionError(
        ErrorCode::kBadArgument,
        "orientation=\"wrist\" moves the tool on a line, and this target only turns it",
        {"movel(..., orientation=\"least\")", "movej(...)"});
  }
  std::optional<MotionError> first;
  for (const JointVector& end : ends) {
    InsertionOptions how;
    how.position_tolerance = tolerance_.position;
    how.angle_tolerance = tolerance_.angle;
    how.hold = Hold::kWrist;
    how.wrist_goal = end;
    try {
      Leg leg = follow(curve, start, how);
      if (!std::holds_alternative<PositionTarget>(target)) {
        require_arrival({JointTarget{end}, Orientation::kWrist}, leg);
      }
      return leg;
    } catch (const MotionError& error) {
      if (!first) first = error;
    }
  }
  throw *first;
}

void LegBuilder::apply(Leg& leg, const MoveOptions& options, int step) const {
  leg.step = step;
  leg.options = options;
  JointPath path;
  for (JointPiece piece : leg.path.pieces()) {
    piece.move = step;
    piece.scale = options.scale.value_or(1.0);
    if (leg.cartesian) limit_tool(robot_, piece, leg.wishes());
    path.append(std::move(piece));
  }
  leg.path = std::move(path);
}

}  // namespace viapoint::planning
