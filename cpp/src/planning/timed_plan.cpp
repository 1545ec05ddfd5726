#include "viapoint/planning/timed_plan.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "planning/itinerary.hpp"
#include "planning/timed_follower.hpp"
#include "planning/timed_points.hpp"
#include "viapoint/path/drive_transform.hpp"
#include "viapoint/profile/quartic_transition.hpp"

namespace viapoint {
namespace {

/// How far the motion may begin from the program's start [rad or m].
constexpr double kSamePlace = 1e-6;
/// Angular velocity that does not count as a jump [rad/s].
constexpr double kSmooth = 1e-9;
/// Instants of a motion at which manipulability is looked at.
constexpr int kManipulabilityChecks = 200;

/// q(u) of the laws' common parts, each a piece with u = x.
std::vector<TrajectoryPiece> pieces_of(const std::vector<AxisLaw>& laws) {
  std::vector<TrajectoryPiece> pieces;
  for (size_t part = 0; part < laws.front().parts().size(); ++part) {
    const Polynomial& first = laws.front().parts()[part];
    TrajectoryPiece piece;
    piece.duration = first.t1 - first.t0;
    piece.joints = static_cast<std::int32_t>(laws.size());
    piece.timing[1] = 1.0;
    for (size_t joint = 0; joint < laws.size(); ++joint) {
      double power = 1.0;
      for (size_t k = 0; k < 6; ++k) {
        piece.path[k][joint] = laws[joint].parts()[part].c[k] * power;
        power *= piece.duration;
      }
    }
    pieces.push_back(piece);
  }
  return pieces;
}

std::vector<TrajectoryPiece> joint_pieces(const std::vector<JointVector>& points,
                                          const std::vector<double>& durations, double t_acc) {
  std::vector<AxisLaw> laws;
  for (Eigen::Index joint = 0; joint < points.front().size(); ++joint) {
    std::vector<double> values;
    for (const JointVector& q : points) values.push_back(q[joint]);
    laws.push_back(quartic_transitions(values, durations, t_acc));
  }
  return pieces_of(laws);
}

Problem elsewhere(const JointVector& start, const JointVector& first, int joint) {
  char text[160];
  std::snprintf(text, sizeof text,
                "the timed motion begins with joint %d at %.6g, but the program starts at %.6g",
                joint + 1, first[joint], start[joint]);
  Problem problem;
  problem.code = ErrorCode::kNotAtStart;
  problem.message = text;
  problem.ways_out = {"start the program at the first point"};
  problem.joint = joint;
  problem.time = 0.0;
  problem.value = first[joint];
  problem.limit = start[joint];
  return problem;
}

std::vector<Problem> angular_jumps(const DriveMotion& motion) {
  std::vector<Problem> problems;
  for (size_t part = 1; part < motion.parts(); ++part) {
    const double t = motion.start_of(part);
    const double jump = (motion.at(part, t).angular_velocity -
                         motion.at(part - 1, motion.end_of(part - 1)).angular_velocity)
                            .norm();
    if (jump <= kSmooth) continue;
    char text[160];
    std::snprintf(
        text, sizeof text,
        "the tool's angular velocity jumps by %.4g rad/s at %.6g s, where a transition of "
        "the drive transform meets a line",
        jump, t);
    Problem problem;
    problem.code = ErrorCode::kDiscontinuous;
    problem.message = text;
    problem.ways_out = {"use movel with a zone, whose blends are continuous in orientation"};
    problem.time = t;
    problem.value = jump;
    problem.limit = 0.0;
    problems.push_back(std::move(problem));
  }
  return problems;
}

/// Puts a timed move's pieces and findings together.
class TimedPlan {
 public:
  TimedPlan(const RobotModel& robot, const MotionProgram& program, const TimedMove& move, int step)
      : robot_(robot), program_(program), move_(move), step_(step) {}

  PlannedMotion make() {
    try {
      const std::vector<double> durations = planning::durations_of(move_);
      check_transitions(move_.points.size(), durations, move_.t_acc);
      if (move_.space == TimedSpace::kJoint) {
        in_joint_space(durations);
      } else {
        in_cartesian_space(durations);
      }
    } catch (const MotionError& error) {
      // There is no motion to hand out: what is missing is the report.
      add(error.problem());
    }
    return std::move(motion_);
  }

 private:
  void in_joint_space(const std::vector<double>& durations) {
    const std::vector<JointVector> points = planning::joints_of(robot_, program_.start, move_);
    report_start(points.front());
    finish(joint_pieces(points, durations, move_.t_acc));
  }

  void in_cartesian_space(const std::vector<double>& durations) {
    const planning::ToolPoints points = planning::tool_points_of(robot_, program_.start, move_);
    const DriveMotion tool(points.poses, durations, move_.t_acc);
    report_start(points.first);
    for (Problem& problem : angular_jumps(tool)) add(std::move(problem));
    planning::TimedPieces followed = planning::follow(robot_, tool, points.first, points.oriented);
    finish(std::move(followed.pieces));
    motion_.trajectory.certificate().path_deviation = followed.position_error;
    motion_.trajectory.certificate().angle_deviation = followed.angle_error;
  }

  void report_start(const JointVector& first) {
    Eigen::Index joint = 0;
    if ((first - program_.start).cwiseAbs().maxCoeff(&joint) > kSamePlace) {
      add(elsewhere(program_.start, first, static_cast<int>(joint)));
    }
  }

  void finish(std::vector<TrajectoryPiece> pieces) {
    for (TrajectoryPiece& piece : pieces) piece.move = step_;
    motion_.trajectory = Trajectory(std::move(pieces), robot_.limits());
    for (const Problem& problem : motion_.trajectory.certificate().problems) add(problem);
    if (!robot_.has_kinematics()) return;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kManipulabilityChecks; ++i) {
      const double t = motion_.trajectory.duration() * i / kManipulabilityChecks;
      least = std::min(least, robot_.manipulability(motion_.trajectory.at(t).q));
    }
    motion_.trajectory.certificate().manipulability = least;
  }

  void add(Problem problem) {
    problem.severity = Severity::kError;
    planning::locate(problem, program_, step_);
    motion_.report.problems.push_back(std::move(problem));
  }

  const RobotModel& robot_;
  const MotionProgram& program_;
  const TimedMove& move_;
  const int step_;
  PlannedMotion motion_;
};

}  // namespace

PlannedMotion plan_timed(const RobotModel& robot, const MotionProgram& program,
                         const TimedMove& move, int step) {
  return TimedPlan(robot, program, move, step).make();
}

}  // namespace viapoint
