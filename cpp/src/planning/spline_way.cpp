#include "planning/spline_way.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "viapoint/core/units.hpp"
#include "viapoint/path/position_limits.hpp"
#include "viapoint/path/spline.hpp"
#include "viapoint/path/tangent_orientation.hpp"

namespace viapoint::planning {
namespace {

/// Neighbours nearer than this are the same point [m or rad].
constexpr double kSamePoint = 1e-6;
/// Travel that counts as much as a turn of 1 rad where points are placed along a spline [m].
constexpr double kTravelOfARadian = 0.1;
/// A curve slower than this share of its mean, by its parameter, has a cusp.
constexpr double kCusp = 1e-3;
/// How near the tool's orientation is led to the curve's direction [rad].
constexpr double kTangentTolerance = 1e-4;
constexpr size_t kMostBezierPoints = 5;
constexpr size_t kBSplineDegree = 3;

[[noreturn]] void refuse(ErrorCode code, std::string message, std::vector<std::string> ways_out) {
  throw MotionError(code, std::move(message), std::move(ways_out));
}

/// "the start", "points[0]", …: the points of a spline as its caller knows them.
std::string name_of(size_t knot) {
  return knot == 0 ? "the start" : "points[" + std::to_string(knot - 1) + "]";
}

bool passes_its_points(SplineKind kind) {
  return kind == SplineKind::kCubic || kind == SplineKind::kQuintic;
}

/// Where the points lie along the spline: 0, then growing by the distances between neighbours, or
/// as the move says, brought to the same length.
std::vector<double> places_of(const SplineMove& move, const std::vector<double>& distances) {
  std::vector<double> at = {0.0};
  for (size_t k = 0; k < distances.size(); ++k) {
    if (passes_its_points(move.kind) && !(distances[k] > kSamePoint)) {
      refuse(ErrorCode::kDegenerateCurve,
             name_of(k) + " and " + name_of(k + 1) + " of the spline are the same point",
             {"leave one of them out"});
    }
    at.push_back(at.back() + distances[k]);
  }
  if (move.at.empty()) return at;
  if (!passes_its_points(move.kind) || move.at.size() != at.size()) {
    refuse(ErrorCode::kBadArgument,
           std::to_string(move.at.size()) + " places are given for the start and " +
               std::to_string(move.points.size()) +
               " points; a cubic or quintic spline takes one each, other kinds none",
           {});
  }
  const double length = at.back();
  const double range = move.at.back() - move.at.front();
  for (size_t k = 1; k < at.size(); ++k) {
    if (!(move.at[k] > move.at[k - 1]) || !std::isfinite(range)) {
      refuse(ErrorCode::kBadArgument, "the places of a spline's points must rise", {});
    }
    at[k] = length * (move.at[k] - move.at[0]) / range;
  }
  return at;
}

/// The curve of the move's kind, of any dimension.
JointPath path_by(const SplineMove& move, const std::vector<JointVector>& points,
                  const std::vector<double>& at) {
  switch (move.kind) {
    case SplineKind::kCubic:
      return quintic_chain(natural_spline(points, at, 3), at);
    case SplineKind::kQuintic:
      return quintic_chain(natural_spline(points, at, 5), at);
    case SplineKind::kBezier:
      if (move.points.size() > kMostBezierPoints) {
        refuse(ErrorCode::kBadArgument,
               "a Bézier curve by " + std::to_string(move.points.size()) +
                   " control points after the start; it may have 5",
               {"kind=\"b_spline\" takes any number"});
      }
      return b_spline_path(points, static_cast<int>(move.points.size()), at.back());
    case SplineKind::kBSpline:
      break;
  }
  return b_spline_path(points, static_cast<int>(std::min(kBSplineDegree, move.points.size())),
                       at.back());
}

void require_points(const SplineMove& move) {
  if (!move.points.empty()) return;
  refuse(ErrorCode::kBadArgument, "a spline without points",
         {"give the poses or joints it leads through"});
}

void refuse_cusp(const JointPath& path) {
  const SlowestPlace slowest = slowest_place(path, kCusp);
  if (slowest.share >= 0.5 * kCusp) return;
  Problem problem;
  problem.code = ErrorCode::kDegenerateCurve;
  problem.share = slowest.s / path.length();
  char text[160];
  std::snprintf(text, sizeof text,
                "the spline has a cusp at %.2f %% of its length: its direction jumps there",
                100.0 * *problem.share);
  problem.message = text;
  problem.ways_out = {"move the points near it", "end the move there and begin another"};
  throw MotionError(std::move(problem));
}

/// Whether the curve passes the orientation of every point, or its tool axis.
bool passes_orientations(const SplineMove& move, Hold hold) {
  return hold == Hold::kAxis || (hold == Hold::kPose && move.orientation == Orientation::kThrough);
}

/// The poses of start and points, and that every one has an orientation where it counts.
std::vector<Pose> poses_of(const SplineMove& move, const RobotModel& robot,
                           const JointVector& start) {
  std::vector<Pose> poses = {robot.forward().pose(start)};
  const auto is_position = [](const Target& target) {
    return std::holds_alternative<PositionTarget>(target);
  };
  const auto positions = std::count_if(move.points.begin(), move.points.end(), is_position);
  const auto all = static_cast<std::ptrdiff_t>(move.points.size());
  const bool oriented =
      move.orientation == Orientation::kThrough || move.orientation == Orientation::kSpin;
  if (oriented && positions > 0 && positions < all) {
    const auto first = std::find_if(move.points.begin(), move.points.end(), is_position);
    refuse(ErrorCode::kBadArgument,
           name_of(static_cast<size_t>(first - move.points.begin()) + 1) +
               " is a position, and others are poses: this orientation needs all of one kind",
           {"give every point as a pose", "orientation=\"least\", \"fixed\", \"tangent\""});
  }
  for (const Target& target : move.points) poses.push_back(pose_of(robot, target, start));
  if (move.orientation == Orientation::kSpin) {
    // However the points are spun about the tool, the axis turns the least from each to the next.
    for (size_t k = 1; k < poses.size(); ++k) {
      poses[k].linear() = least_turned_axis(poses[k - 1].linear(), poses[k].linear());
    }
  }
  return poses;
}

void require_at_start(const SplineMove& move, const RobotModel& robot,
                      const LineTolerance& tolerance, const JointVector& start) {
  if (!move.start) return;
  const Pose here = robot.forward().pose(start);
  const Pose wanted = pose_of(robot, *move.start, start);
  const double off = (here.translation() - wanted.translation()).norm();
  const Hold hold = hold_of(move.orientation, *move.start);
  const double turned = rotation_distance(
      here.linear(),
      hold == Hold::kAxis ? least_turned_axis(here.linear(), wanted.linear()) : wanted.linear());
  const bool oriented = passes_orientations(move, hold);
  if (off <= tolerance.position && (!oriented || turned <= tolerance.angle)) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the curve begins %.4g mm and %.3g° from where the arm is at the start of this move",
      off / kMillimetre, turned / kDegree);
  Problem problem;
  problem.code = ErrorCode::kDiscontinuous;
  problem.message = text;
  problem.value = off;
  problem.limit = tolerance.position;
  problem.ways_out = {"move to the curve's first pose before it: movel(...) or movej(...)"};
  throw MotionError(std::move(problem));
}

std::unique_ptr<const OrientationCurve> orientation_of(const SplineMove& move, Hold hold,
                                                       const std::vector<Pose>& poses,
                                                       const std::vector<double>& at,
                                                       const PositionCurve& position) {
  const Eigen::Matrix3d from = poses.front().linear();
  if (hold == Hold::kPose && move.orientation == Orientation::kLeast) {
    return least_turn(from, poses.back().linear(), position.length());
  }
  if (hold == Hold::kPose && move.orientation == Orientation::kTangent) {
    return std::make_unique<OrientationSpline>(follow_tangent(position, from, kTangentTolerance));
  }
  if (passes_orientations(move, hold)) {
    std::vector<Eigen::Matrix3d> rotations;
    for (const Pose& pose : poses) rotations.emplace_back(pose.linear());
    return std::make_unique<OrientationSpline>(OrientationSpline::through(rotations, at));
  }
  return std::make_unique<SteadyTurn>(from, Eigen::Vector3d::Zero());
}

[[noreturn]] void throw_crossing(const RobotModel& robot, const LimitCrossing& crossing,
                                 double share) {
  Problem problem;
  problem.share = share;
  problem.value = crossing.value;
  problem.limit = crossing.limit;
  char where[64];
  std::snprintf(where, sizeof where, " at %.2f %% of the spline", 100.0 * share);
  if (crossing.joint >= 0) {
    problem.code = ErrorCode::kJointLimit;
    problem.joint = crossing.joint;
    problem.message = "joint " + std::to_string(crossing.joint + 1) + " passes its limit of " +
                      in_words(robot, crossing.joint, crossing.limit) + where +
                      " and would go to " + in_words(robot, crossing.joint, crossing.value);
  } else {
    problem.code = ErrorCode::kCouplingLimit;
    problem.message = "coupled limit " + std::to_string(crossing.coupling + 1) + ", " +
                      std::to_string(crossing.limit) + ", is passed" + where +
                      "; its value would go to " + std::to_string(crossing.value);
  }
  problem.ways_out = {"add points that keep the spline away from the limit",
                      "kind=\"b_spline\": it stays within the hull of its control points"};
  throw MotionError(std::move(problem));
}

}  // namespace

ToolWay way_of(const SplineMove& move, const RobotModel& robot, const LineTolerance& tolerance,
               const JointVector& start) {
  require_kinematics(robot);
  require_points(move);
  require_at_start(move, robot, tolerance, start);
  const std::vector<Pose> poses = poses_of(move, robot, start);
  ToolWay way;
  way.goal = move.points.back();
  way.hold = hold_of(move.orientation, way.goal);
  way.joints_count = move.orientation == Orientation::kLeast ||
                     move.orientation == Orientation::kThrough ||
                     move.orientation == Orientation::kWrist;
  const bool oriented = passes_orientations(move, way.hold);
  std::vector<double> distances;
  std::vector<JointVector> positions = {poses[0].translation()};
  double farthest = 0.0;
  for (size_t k = 1; k < poses.size(); ++k) {
    positions.emplace_back(poses[k].translation());
    const double travel = (positions[k] - positions[k - 1]).norm();
    const double turn = rotation_distance(poses[k].linear(), poses[k - 1].linear());
    distances.push_back(oriented ? std::hypot(travel, kTravelOfARadian * turn) : travel);
    farthest = std::max(farthest, (positions[k] - positions[0]).norm());
  }
  const std::vector<double> at = places_of(move, distances);
  if (!(at.back() > kNowhere)) {
    refuse(ErrorCode::kZeroLength, "the spline goes nowhere: the tool is already there", {});
  }
  JointPath path = path_by(move, positions, at);
  const bool on_the_spot = farthest < kSamePoint;
  if (!on_the_spot) refuse_cusp(path);
  auto position = std::make_unique<SplineCurve>(std::move(path));
  const std::vector<double> turned_at =
      passes_its_points(move.kind)
          ? at
          : greville_abscissae(poses.size(),
                               static_cast<int>(move.kind == SplineKind::kBezier
                                                    ? move.points.size()
                                                    : std::min(kBSplineDegree, move.points.size())),
                               at.back());
  auto orientation = orientation_of(move, way.hold, poses, turned_at, *position);
  way.curve = std::make_unique<ToolCurve>(std::move(position), std::move(orientation));
  return way;
}

JointPath joint_spline(const SplineMove& move, const RobotModel& robot,
                       const std::vector<JointVector>& points) {
  std::vector<double> distances;
  for (size_t k = 1; k < points.size(); ++k) {
    distances.push_back((points[k] - points[k - 1]).norm());
  }
  const std::vector<double> at = places_of(move, distances);
  if (!(at.back() > kNowhere)) {
    refuse(ErrorCode::kZeroLength, "the spline goes nowhere: the arm is already there", {});
  }
  JointPath path = path_by(move, points, at);
  refuse_cusp(path);
  for (size_t k = 0; k < path.pieces().size(); ++k) {
    if (const auto crossing = piece_position_violation(path.pieces()[k], robot.limits())) {
      throw_crossing(robot, *crossing, (path.start_of(k) + crossing->s) / path.length());
    }
  }
  return path;
}

}  // namespace viapoint::planning
