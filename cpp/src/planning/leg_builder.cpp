#include "planning/leg_builder.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planning/chosen_way.hpp"
#include "planning/spline_way.hpp"
#include "planning/tool_way.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint::planning {
namespace {

/// So many ends of the wrist are tried at most. Wide position limits allow every branch on hundreds
/// of turns of the wrist, and where the nearest of them lead nowhere, one more turn does not help.
constexpr size_t kMostWristEnds = 32;

/// The nearest ends whose joints from `wrist` on differ: the others follow the curve.
std::vector<JointVector> distinct_by_wrist(const std::vector<JointVector>& ends,
                                           Eigen::Index wrist) {
  std::vector<JointVector> distinct;
  for (const JointVector& end : ends) {
    if (distinct.size() == kMostWristEnds) break;
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const JointVector& other) {
      return (end - other).tail(wrist).cwiseAbs().maxCoeff() < kNowhere;
    });
    if (!known) distinct.push_back(end);
  }
  return distinct;
}

}  // namespace

JointVector LegBuilder::resolve(const Target& target, const JointVector& near) const {
  if (const auto* joints = std::get_if<JointTarget>(&target)) {
    require_within_limits(robot_, joints->q, "the target");
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
  leg.straight = move;
  return leg;
}

Leg LegBuilder::follow(const TaskCurve& curve, const JointVector& start,
                       const InsertionOptions& how) const {
  return leg_of(start, insert_curve(robot_.forward(), robot_.limits(), curve, start, how));
}

Leg LegBuilder::leg_of(const JointVector& start, Insertion inserted) {
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
  Leg leg = travel(way_of(move, robot_, start), start);
  leg.straight = move;
  return leg;
}

Leg LegBuilder::lin_to(const LinMove& move, const JointVector& start,
                       const JointVector& goal) const {
  const ToolWay way = way_of(move, robot_, start);
  const InsertionOptions how = options_for(way.hold);
  std::optional<Insertion> chosen;
  if (leaves_one_open(robot_, how.hold)) {
    chosen = insert_with_choice(robot_, *way.curve, start, &goal, how);
  }
  if (!chosen) {
    throw MotionError(ErrorCode::kBranchChange, "no way along the line leads to these joints");
  }
  return leg_of(start, *std::move(chosen));
}

Leg LegBuilder::circ(const CircMove& move, const JointVector& start) const {
  return travel(way_of(move, robot_, start), start);
}

Leg LegBuilder::turn(const TurnMove& move, const JointVector& start) const {
  return travel(way_of(move, robot_, start), start);
}

Target LegBuilder::goal_of(const TurnMove& move, const JointVector& start) const {
  return way_of(move, robot_, start).goal;
}

Leg LegBuilder::spline(const SplineMove& move, const JointVector& start) const {
  if (move.space == SplineSpace::kTool) {
    return travel(way_of(move, robot_, tolerance_, start), start);
  }
  std::vector<JointVector> points = {start};
  for (const Target& target : move.points) points.push_back(resolve(target, points.back()));
  Leg leg;
  leg.start = start;
  leg.goal = points.back();
  leg.path = joint_spline(move, robot_, points);
  return leg;
}

InsertionOptions LegBuilder::options_for(Hold hold) const {
  InsertionOptions how;
  how.position_tolerance = tolerance_.position;
  how.angle_tolerance = tolerance_.angle;
  how.hold = hold;
  return how;
}

Leg LegBuilder::travel(const ToolWay& way, const JointVector& start) const {
  if (way.hold == Hold::kWrist) return travel_by_wrist(way, start);
  const InsertionOptions how = options_for(way.hold);
  const auto* joints = std::get_if<JointTarget>(&way.goal);
  const JointVector* arrival = joints != nullptr && way.joints_count ? &joints->q : nullptr;
  try {
    Leg leg = follow(*way.curve, start, how);
    if (arrival != nullptr) require_arrival(*arrival, leg);
    return leg;
  } catch (const MotionError& error) {
    // A place on the curve where joints cannot go on, and no fault of the curve itself.
    if (!error.problem().share || !leaves_one_open(robot_, how.hold)) throw;
    std::optional<Insertion> chosen = insert_with_choice(robot_, *way.curve, start, arrival, how);
    if (!chosen) throw;
    return leg_of(start, *std::move(chosen));
  }
}

void LegBuilder::require_arrival(const JointVector& wanted, const Leg& leg) const {
  const JointVector miss = (wanted - leg.goal).cwiseAbs();
  int worst = 0;
  if (miss.maxCoeff(&worst) <= kSameBranch) return;
  Problem problem;
  problem.code = ErrorCode::kBranchChange;
  problem.joint = worst;
  problem.value = leg.goal[worst];
  problem.limit = wanted[worst];
  problem.share = 1.0;
  problem.message = "the move reaches the target's pose on another branch: joint " +
                    std::to_string(worst + 1) + " arrives at " +
                    in_words(robot_, worst, leg.goal[worst]) + ", the target has " +
                    in_words(robot_, worst, wanted[worst]);
  throw MotionError(std::move(problem));
}

std::vector<JointVector> LegBuilder::wrist_ends(const Target& goal,
                                                const JointVector& start) const {
  if (const auto* joints = std::get_if<JointTarget>(&goal)) {
    require_within_limits(robot_, joints->q, "the target");
    return {joints->q};
  }
  const Eigen::Index wrist = robot_.joints() - 3;
  if (const auto* pose = std::get_if<PoseTarget>(&goal)) {
    std::vector<JointVector> ends = robot_.inverse().solve_all(pose->pose_base_tool);
    std::sort(ends.begin(), ends.end(), [&](const JointVector& a, const JointVector& b) {
      return (a - start).tail(wrist).cwiseAbs().maxCoeff() <
             (b - start).tail(wrist).cwiseAbs().maxCoeff();
    });
    return ends;
  }
  JointVector end = resolve(goal, start);
  end.tail(wrist) = start.tail(wrist);
  return {end};
}

Leg LegBuilder::travel_by_wrist(const ToolWay& way, const JointVector& start) const {
  if (robot_.joints() <= 3) {
    throw MotionError(ErrorCode::kUncontrolled,
                      "orientation=\"wrist\" needs wrist joints beyond the first three; " +
                          robot_.name() + " has " + std::to_string(robot_.joints()) + " joints",
                      {"movel(position=...)", "movej"});
  }
  // Each branch of the target is a possible end: the nearest by its wrist joints that the first
  // three joints really lead to.
  const std::vector<JointVector> ends = wrist_ends(way.goal, start);
  if (way.curve->length() < kNowhere) {
    if ((ends.front() - start).cwiseAbs().maxCoeff() < kNowhere) {
      throw MotionError(ErrorCode::kZeroLength, "the move goes nowhere: the tool is already there");
    }
    throw MotionError(
        ErrorCode::kBadArgument,
        "orientation=\"wrist\" moves the tool on a line, and this target only turns it",
        {"movel(..., orientation=\"least\")", "movej(...)"});
  }
  const auto is_end = [&](const JointVector& q) {
    return std::any_of(ends.begin(), ends.end(), [&](const JointVector& end) {
      return (end - q).cwiseAbs().maxCoeff() <= kSameBranch;
    });
  };
  std::optional<MotionError> first;
  for (const JointVector& end : distinct_by_wrist(ends, robot_.joints() - 3)) {
    InsertionOptions how = options_for(Hold::kWrist);
    how.wrist_goal = end;
    try {
      Leg leg = follow(*way.curve, start, how);
      const bool anywhere = std::holds_alternative<PositionTarget>(way.goal);
      if (!anywhere && !is_end(leg.goal)) require_arrival(end, leg);
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
    piece.tool = leg.tool_limits();
    path.append(std::move(piece));
  }
  leg.path = std::move(path);
}

}  // namespace viapoint::planning
