#include <algorithm>
#include <string>
#include <vector>

#include "benches.hpp"
#include "json_line.hpp"
#include "kinematics/random_lines.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/pose_path.hpp"
#include "viapoint/planning/motion_planner.hpp"

namespace viapoint::bench {
namespace {

/// A line that cannot be followed is tried again with steps this much shorter: what then works was
/// no change of branch but a quick turn.
constexpr int kFiner = 16;

struct Tally {
  int followed = 0;
  int jumps = 0;
  int changes = 0;  ///< lines that no choice of branch follows
  int quick = 0;    ///< of these, that shorter steps follow
  int failed = 0;
  double worst = 0.0;       ///< error of a pose [m, rad]
  double by_nearest = 0.0;  ///< lines that the nearest solution alone follows
  int planned = 0;          ///< lines as movel
  int refused = 0;          ///< of these, with the share of the way where joints cannot follow
  int unplaced = 0;         ///< refused without such a place
  int only_followed = 0;    ///< refused though the poses can be followed one by one
};

bool can_be_followed(const RobotModel& robot, const testing::Line& line) {
  try {
    (void)follow_poses(robot, line.poses, line.start);
    return true;
  } catch (const MotionError&) {
    return false;
  }
}

/// The same line as a move of a program, from the joints that the poses are followed from.
void plan(const RobotPtr& robot, const testing::Line& line, bool followed, Tally& tally) {
  MotionProgram program;
  program.robot = robot->name();
  program.robot_fingerprint = robot->fingerprint();
  program.start = robot->inverse().solve_near(line.poses.front(), line.start);
  Step step;
  step.what = LinMove{PoseTarget{line.poses.back()}, Orientation::kLeast};
  program.steps.push_back(step);
  try {
    (void)MotionPlanner(robot).plan(program);
    ++tally.planned;
  } catch (const MotionError& error) {
    if (error.problem().share) {
      ++tally.refused;
    } else {
      ++tally.unplaced;
    }
    tally.only_followed += followed ? 1 : 0;
  }
}

void follow(const RobotPtr& arm_model, const testing::LineArm& arm, bool through, int seed,
            Tally& tally) {
  const RobotModel& robot = *arm_model;
  const auto number = static_cast<std::uint64_t>(seed);
  const testing::Line line = testing::random_line(robot, arm.singular_joint, through, number);
  JointVector q = robot.inverse().solve_near(line.poses.front(), line.start);
  bool jumped = false;
  for (const Pose& pose : line.poses) {
    const JointVector next = robot.inverse().solve_near(pose, q);
    jumped = jumped || (next - q).cwiseAbs().maxCoeff() > kLargestStep;
    q = next;
  }
  tally.by_nearest += jumped ? 0.0 : 1.0;
  bool followed = false;
  try {
    const std::vector<JointVector> way = follow_poses(robot, line.poses, line.start);
    followed = true;
    ++tally.followed;
    for (size_t k = 0; k < way.size(); ++k) {
      const Pose reached = robot.forward().pose(way[k]);
      tally.worst =
          std::max({tally.worst, (reached.translation() - line.poses[k].translation()).norm(),
                    rotation_distance(reached.linear(), line.poses[k].linear())});
      if (k > 0 && (way[k] - way[k - 1]).cwiseAbs().maxCoeff() > kLargestStep) ++tally.jumps;
    }
  } catch (const MotionError& error) {
    if (error.code() != ErrorCode::kBranchChange) ++tally.failed;
    tally.changes += error.code() == ErrorCode::kBranchChange ? 1 : 0;
    const testing::Line finer = testing::random_line(robot, arm.singular_joint, through, number,
                                                     kFiner * testing::kLineSteps);
    tally.quick += can_be_followed(robot, finer) ? 1 : 0;
  }
  plan(arm_model, line, followed, tally);
}

}  // namespace

void bench_tracking(int lines) {
  for (const testing::LineArm& arm : testing::kLineArms) {
    const RobotPtr robot = RobotModel::make(load_description(arm.name));
    for (const bool through : {true, false}) {
      Tally tally;
      for (int seed = 0; seed < std::max(1, lines / 2); ++seed) {
        follow(robot, arm, through, seed, tally);
      }
      JsonLine("tracking", std::string(arm.name) + (through ? ", through singular" : ", anywhere"))
          .add("lines", std::max(1, lines / 2))
          .add("followed", tally.followed)
          .add("failed_steps", tally.failed)
          .add("jumps", tally.jumps)
          .add("must_change_branch", tally.changes)
          .add("of_these_only_quick", tally.quick)
          .add("by_nearest_alone", tally.by_nearest)
          .add("worst_error", tally.worst)
          .add("movel_planned", tally.planned)
          .add("movel_refused_with_place", tally.refused)
          .add("movel_refused_without", tally.unplaced)
          .add("movel_refused_though_followed", tally.only_followed);
    }
  }
}

}  // namespace viapoint::bench
