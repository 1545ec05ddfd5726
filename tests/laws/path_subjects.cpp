#include "path_subjects.hpp"

#include <random>
#include <utility>

#include "corner_subjects.hpp"
#include "planning/planner_fixture.hpp"

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

std::vector<Subject<PathCase>> joint_paths() {
  return {
      {"JointLine", joint_line},
      {"Hermite", hermite},
      {"PartOfHermite", part_of_hermite},
      {"HermiteChain", hermite_chain},
  };
}

std::vector<Subject<ToolPathCase>> tool_paths() {
  return {
      {"StraightLine", straight_line},
      {"StraightLineWithWrist", straight_line_with_wrist},
      {"StraightLineOfPosition", straight_line_of_position},
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
      {"TurnOnTheSpot",
       [] {
         return std::make_shared<LineCurve>(pose_at(0.1, -0.4, 0.3, {0.4, 0.2, -1.0}),
                                            pose_at(0.1, -0.4, 0.3, {-0.3, 1.2, 0.6}));
       }},
  };
}

}  // namespace viapoint::laws
