#include "path_subjects.hpp"

#include <memory>
#include <random>
#include <utility>

#include "corner_subjects.hpp"
#include "path/random_curves.hpp"
#include "planning/planner_fixture.hpp"
#include "viapoint/path/spline.hpp"
#include "viapoint/path/tangent_orientation.hpp"

namespace viapoint::laws {
namespace {

using testing_planner::puma_a;
using testing_planner::puma_b;
using testing_planner::puma_c;
using testing_planner::robot;

constexpr int kJoints = 6;

JointVector random_joints(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  JointVector v(kJoints);
  for (int i = 0; i < kJoints; ++i) v[i] = uniform(random);
  return v;
}

PathPoint random_knot(std::mt19937_64& random) {
  JointVector q = random_joints(random, 2.0);
  JointVector q1 = random_joints(random, 1.0);
  JointVector q2 = random_joints(random, 3.0);
  return {std::move(q), std::move(q1), std::move(q2), JointVector::Zero(kJoints)};
}

PathCase case_of(const JointPiece& piece, const JointVector& first, const JointVector& last) {
  PathCase result{{}, first, last};
  result.path.append(piece);
  return result;
}

PathCase joint_line() {
  std::mt19937_64 random(1);
  const JointVector a = random_joints(random, 2.0);
  const JointVector b = random_joints(random, 2.0);
  return case_of(JointPiece::line(a, b, 0.7), a, b);
}

PathCase hermite() {
  std::mt19937_64 random(2);
  const PathPoint a = random_knot(random);
  const PathPoint b = random_knot(random);
  return case_of(JointPiece::hermite(a, b, 1.3), a.q, b.q);
}

PathCase part_of_hermite() {
  std::mt19937_64 random(3);
  const JointPiece whole = JointPiece::hermite(random_knot(random), random_knot(random), 1.3);
  return case_of(whole.part(0.31, 1.02), whole.at(0.31).q, whole.at(1.02).q);
}

/// Hermite pieces of very different lengths through common knots.
PathCase hermite_chain() {
  std::mt19937_64 random(4);
  PathPoint from = random_knot(random);
  PathCase result{{}, from.q, {}};
  for (const double length : {0.5, 2.0, 0.01, 0.3, 1.0, 0.004, 0.7}) {
    PathPoint to = random_knot(random);
    // Short pieces must not be asked to leap.
    to.q = from.q + length * to.q;
    result.path.append(JointPiece::hermite(from, to, length));
    from = to;
  }
  result.last = from.q;
  return result;
}

ToolPathCase inserted(const RobotPtr& arm, std::shared_ptr<const TaskCurve> curve,
                      const JointVector& start, const InsertionOptions& options) {
  ToolPathCase result;
  result.arm = arm;
  result.curve = std::move(curve);
  result.options = options;
  result.insertion = insert_curve(arm->forward(), arm->limits(), *result.curve, start, options);
  for (const JointPiece& piece : result.insertion.pieces) result.path.append(piece);
  result.first = start;
  result.last = result.insertion.knots.back();
  return result;
}

ToolPathCase straight_line() {
  const RobotPtr puma = robot("puma560");
  const ForwardKinematics& arm = puma->forward();
  return inserted(puma, std::make_shared<LineCurve>(arm.pose(puma_a()), arm.pose(puma_b())),
                  puma_a(), {});
}

ToolPathCase straight_line_with_wrist() {
  const RobotPtr puma = robot("puma560");
  const ForwardKinematics& arm = puma->forward();
  InsertionOptions options;
  options.hold = Hold::kWrist;
  options.wrist_goal = puma_c();
  return inserted(puma, std::make_shared<LineCurve>(arm.pose(puma_b()), arm.pose(puma_c())),
                  puma_b(), options);
}

ToolPathCase straight_line_of_position() {
  const RobotPtr arm = robot("two_link");
  InsertionOptions options;
  options.hold = Hold::kPosition;
  const JointVector start = testing_planner::degrees({10.0, 60.0});
  const Pose from = arm->forward().pose(start);
  const Pose to = arm->forward().pose(testing_planner::degrees({60.0, 80.0}));
  return inserted(arm,
                  std::make_shared<LineCurve>(LineCurve::fixed_orientation(from, to.translation())),
                  start, options);
}

/// Where the arcs and splines of the tool begin on the puma560.
JointVector puma_start() { return testing_planner::degrees({0, 25, 0, 15, 50, 10}); }

ToolPathCase circle_and_a_half() {
  const RobotPtr puma = robot("puma560");
  const Pose from = puma->forward().pose(puma_start());
  const Eigen::Vector3d center = from.translation() + Eigen::Vector3d(0.05, 0.02, 0.0);
  return inserted(
      puma, testing::helix(from, center, Eigen::Vector3d(0.2, 0.1, 1.0), 3.0 * kPi, 0.0, false),
      puma_start(), {});
}

ToolPathCase helix_of_position() {
  const RobotPtr arm = robot("rpp");
  JointVector start(3);
  start << 0.3, 0.1, 0.4;
  InsertionOptions options;
  options.hold = Hold::kPosition;
  const Pose from = arm->forward().pose(start);
  const Eigen::Vector3d center = from.translation() + Eigen::Vector3d(0.05, 0.05, 0.0);
  return inserted(arm,
                  testing::helix(from, center, Eigen::Vector3d::UnitZ(), 4.0 * kPi, 0.02, false),
                  start, options);
}

ToolPathCase tool_spline(int degree) {
  const RobotPtr puma = robot("puma560");
  std::mt19937 random(5);
  const auto poses = testing::poses_on_a_walk(puma->forward(), random, puma_start(), 6, 0.1);
  return inserted(puma, testing::spline_through(poses, degree, true), puma_start(), {});
}

PathCase joint_spline(int degree) {
  std::mt19937_64 random(6);
  std::vector<JointVector> points;
  const std::vector<double> at = {0.0, 0.4, 0.5, 1.7, 2.0};
  for (size_t k = 0; k < at.size(); ++k) points.push_back(random_joints(random, 2.0));
  return {quintic_chain(natural_spline(points, at, degree), at), points.front(), points.back()};
}

PathCase joint_b_spline() {
  std::mt19937_64 random(7);
  std::vector<JointVector> control;
  for (int k = 0; k < 7; ++k) control.push_back(random_joints(random, 2.0));
  return {b_spline_path(control, 3, 2.0), control.front(), control.back()};
}

Course course_of(const PathCase& from) {
  Course course;
  course.length = from.path.length();
  for (size_t i = 1; i < from.path.pieces().size(); ++i) {
    course.knots.push_back(from.path.start_of(i));
  }
  course.at = [path = from.path](double s) -> Derivatives {
    const PathPoint point = path.at(s);
    return {point.q, point.q1, point.q2, point.q3};
  };
  course.first = from.first;
  course.last = from.last;
  return course;
}

Pose pose_at(double x, double y, double z, const Eigen::Vector3d& rotation) {
  Pose pose = Pose::Identity();
  pose.translate(Eigen::Vector3d(x, y, z));
  pose.rotate(rotation_exp(rotation));
  return pose;
}

}  // namespace

namespace {

using CurvePtr = std::shared_ptr<const TaskCurve>;

CurvePtr arc_by_three_points() {
  const Pose from = pose_at(0.1, -0.4, 0.3, {0.4, 0.2, -1.0});
  const Pose to = pose_at(0.5, 0.2, 0.1, {-0.3, 1.2, 0.6});
  auto arc = std::make_unique<HelixCurve>(
      HelixCurve::through(from.translation(), Eigen::Vector3d(0.3, 0.3, 0.4), to.translation()));
  auto turn =
      std::make_unique<SteadyTurn>(SteadyTurn::between(from.linear(), to.linear(), arc->length()));
  return std::make_shared<ToolCurve>(std::move(arc), std::move(turn));
}

CurvePtr helix_with_its_tangent() {
  return testing::helix(pose_at(0.1, -0.4, 0.3, {0.4, 0.2, -1.0}), {0.3, 0.0, 0.0}, {0.1, 0.5, 1.0},
                        -7.0, 0.05, true);
}

CurvePtr screw_on_its_axis() {
  return testing::helix(pose_at(0.1, -0.4, 0.3, {0.4, 0.2, -1.0}), {0.1, -0.4, 0.3},
                        {0.1, 0.5, 1.0}, 20.0, 0.05, true);
}

/// Poses whose curves are long against their bends, as a tool's are.
std::vector<Pose> waypoints() {
  return {pose_at(0.1, -0.4, 0.3, {0.4, 0.2, -1.0}), pose_at(0.4, -0.3, 0.4, {0.9, 0.1, -0.5}),
          pose_at(0.6, 0.1, 0.2, {0.5, 0.8, 0.1}), pose_at(0.3, 0.5, 0.3, {-0.2, 1.1, 0.4}),
          pose_at(-0.2, 0.6, 0.5, {-0.6, 0.5, 0.2})};
}

CurvePtr spline_led_along_its_tangent() {
  const std::vector<JointVector> points = testing::positions_of(waypoints());
  const std::vector<double> at = {0.0, 0.35, 0.8, 1.3, 1.8};
  auto position = std::make_unique<SplineCurve>(quintic_chain(natural_spline(points, at, 5), at));
  auto turn = std::make_unique<OrientationSpline>(
      follow_tangent(*position, waypoints().front().linear(), 1e-4));
  return std::make_shared<ToolCurve>(std::move(position), std::move(turn));
}

}  // namespace

std::vector<Subject<PathCase>> joint_paths() {
  return {
      {"JointLine", joint_line},
      {"Hermite", hermite},
      {"PartOfHermite", part_of_hermite},
      {"HermiteChain", hermite_chain},
      {"CubicJointSpline", [] { return joint_spline(3); }},
      {"QuinticJointSpline", [] { return joint_spline(5); }},
      {"JointBSpline", joint_b_spline},
  };
}

std::vector<Subject<ToolPathCase>> tool_paths() {
  return {
      {"StraightLine", straight_line},
      {"StraightLineWithWrist", straight_line_with_wrist},
      {"StraightLineOfPosition", straight_line_of_position},
      {"CircleAndAHalf", circle_and_a_half},
      {"HelixOfPosition", helix_of_position},
      {"CubicToolSpline", [] { return tool_spline(3); }},
      {"QuinticToolSpline", [] { return tool_spline(5); }},
  };
}

std::vector<Subject<PathCase>> all_paths() {
  auto paths = seen_as<PathCase>(tool_paths(), [](const ToolPathCase& from) {
    return PathCase{from.path, from.first, from.last};
  });
  paths = joined(std::move(paths), seen_as<PathCase>(corners(), [](const CornerCase& from) {
                   return PathCase{from.path, from.before.at(0.0).q,
                                   from.after.at(from.after.length()).q};
                 }));
  return joined(joint_paths(), paths);
}

std::vector<Subject<Course>> path_courses() { return seen_as<Course>(all_paths(), course_of); }

std::vector<Subject<std::shared_ptr<const TaskCurve>>> tool_curves() {
  return {
      {"Line",
       [] {
         return std::make_shared<LineCurve>(pose_at(0.1, -0.4, 0.3, {0.4, 0.2, -1.0}),
                                            pose_at(0.5, 0.2, 0.1, {-0.3, 1.2, 0.6}));
       }},
      {"LineOfFixedOrientation",
       [] {
         return std::make_shared<LineCurve>(LineCurve::fixed_orientation(
             pose_at(0.1, -0.4, 0.3, {0.4, 0.2, -1.0}), Eigen::Vector3d(0.5, 0.2, 0.1)));
       }},
      {"ArcByThreePoints", arc_by_three_points},
      {"HelixWithItsTangent", helix_with_its_tangent},
      {"ScrewOnItsAxis", screw_on_its_axis},
      {"CubicSpline", []() -> CurvePtr { return testing::spline_through(waypoints(), 3, true); }},
      {"QuinticSpline", []() -> CurvePtr { return testing::spline_through(waypoints(), 5, true); }},
      {"SplineLedAlongItsTangent", spline_led_along_its_tangent},
      {"TurnOnTheSpot",
       [] {
         return std::make_shared<LineCurve>(pose_at(0.1, -0.4, 0.3, {0.4, 0.2, -1.0}),
                                            pose_at(0.1, -0.4, 0.3, {-0.3, 1.2, 0.6}));
       }},
  };
}

}  // namespace viapoint::laws
