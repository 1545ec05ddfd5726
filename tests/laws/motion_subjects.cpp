#include "motion_subjects.hpp"

#include <utility>

#include "path_subjects.hpp"
#include "planning/planner_fixture.hpp"
#include "trajectory/trajectory_fixtures.hpp"
#include "viapoint/trajectory/time_parameterizer.hpp"

namespace viapoint::laws {
namespace {

using namespace testing_planner;

MotionCase smooth_moves() {
  const JointLimits limits = viapoint::testing::uniform_limits(1, 3.0, 4.0, 20.0, 300.0);
  return {Trajectory({viapoint::testing::smooth_move(-1, 1, 1.2),
                      viapoint::testing::smooth_move(1, 0.5, 0.7)},
                     limits),
          limits, JointVector::Constant(1, -1.0), JointVector::Constant(1, 0.5)};
}

/// The quickest timing of a path.
template <typename Case>
MotionCase timed(const Case& from, const JointLimits& limits) {
  return {Trajectory(parameterize(from.path, limits), limits), limits, from.first, from.last};
}

MotionCase timed_in_joints(const PathCase& from) {
  return timed(from, viapoint::testing::uniform_limits(from.path.pieces().front().joints(), 100.0,
                                                       2.0, 15.0, 150.0));
}

MotionCase timed_tool_path(const ToolPathCase& from) { return timed(from, from.arm->limits()); }

MotionCase planned(Script& script, const RobotPtr& arm, const JointVector& last) {
  const MotionPlanner planner(arm);
  return {planner.plan(script.program()).trajectory, arm->limits(), script.program().start, last};
}

MotionCase planned_ptp() {
  const RobotPtr puma = robot("puma560");
  Script script(*puma, puma_a());
  script.movej(puma_b()).movej(puma_c());
  return planned(script, puma, puma_c());
}

MotionCase planned_ptp_with_blend() {
  const RobotPtr puma = robot("puma560");
  Script script(*puma, puma_a());
  script.movej(puma_b(), {ZoneKind::kJointDeviation, 0.05}).movej(puma_c());
  return planned(script, puma, puma_c());
}

MotionCase planned_line_with_wrist_and_wait() {
  const RobotPtr puma = robot("puma560");
  Script script(*puma, puma_a());
  script.movej(puma_b()).add(Wait{0.2});
  MoveOptions options;
  options.speed = 0.25;
  script.add(LinMove{JointTarget{puma_c()}, Orientation::kWrist}, options);
  return planned(script, puma, puma_c());
}

MotionCase planned_fixed_times() {
  const RobotPtr puma = robot("puma560");
  Script script(*puma, puma_a());
  TimedMove move;
  move.points = {
      {JointTarget{puma_a()}, 0.0}, {JointTarget{puma_b()}, 0.5}, {JointTarget{puma_c()}, 0.5}};
  script.add(move);
  return planned(script, puma, puma_c());
}

Course course_of(const MotionCase& from) {
  Course course;
  course.length = from.trajectory.duration();
  for (size_t i = 1; i < from.trajectory.pieces().size(); ++i) {
    course.knots.push_back(from.trajectory.start_of(i));
  }
  course.at = [trajectory = from.trajectory](double t) -> Derivatives {
    const JointState state = trajectory.at(t);
    return {state.q, state.qd, state.qdd, state.qddd};
  };
  course.first = from.first;
  course.last = from.last;
  return course;
}

}  // namespace

std::vector<Subject<MotionCase>> sound_motions() {
  std::vector<Subject<MotionCase>> own = {
      {"SmoothMoves", smooth_moves},
      {"PlannedPtp", planned_ptp},
      {"PlannedPtpWithBlend", planned_ptp_with_blend},
      {"PlannedLineWithWristAndWait", planned_line_with_wrist_and_wait},
  };
  // Every path there is, given its time: under the arm's own limits where it has any.
  own = joined(std::move(own), seen_as<MotionCase>(all_paths(), timed_in_joints));
  return joined(std::move(own),
                seen_as<MotionCase>(named_after(tool_paths(), "OwnLimits"), timed_tool_path));
}

std::vector<Subject<MotionCase>> study_motions() { return {{"FixedTimes", planned_fixed_times}}; }

std::vector<Subject<MotionCase>> all_motions() { return joined(sound_motions(), study_motions()); }

std::vector<Subject<Course>> motion_courses() { return seen_as<Course>(all_motions(), course_of); }

}  // namespace viapoint::laws
