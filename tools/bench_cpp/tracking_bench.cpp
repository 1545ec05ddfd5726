#include <algorithm>
#include <string>
#include <vector>

#include "benches.hpp"
#include "json_line.hpp"
#include "kinematics/random_lines.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/pose_path.hpp"

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
};

void follow(const RobotModel& robot, const testing::LineArm& arm, bool through, int seed,
            Tally& tally) {
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
  try {
    const std::vector<JointVector> way = follow_poses(robot, line.poses, line.start);
    ++tally.followed;
    for (size_t k = 0; k < way.size(); ++k) {
      const Pose reached = robot.forward().pose(way[k]);
      tally.worst =
          std::max({tally.worst, (reached.translation() - line.poses[k].translation()).norm(),
                    rotation_distance(reached.linear(), line.poses[k].linear())});
      if (k > 0 && (way[k] - way[k - 1]).cwiseAbs().maxCoeff() > kLargestStep) ++tally.jumps;
    }
  } catch (const MotionError& error) {
    if (error.code() != ErrorCode::kBranchChange) {
      ++tally.failed;
      return;
    }
    ++tally.changes;
    const testing::Line finer = testing::random_line(robot, arm.singular_joint, through, number,
                                                     kFiner * testing::kLineSteps);
    try {
      (void)follow_poses(robot, finer.poses, finer.start);
      ++tally.quick;
    } catch (const MotionError&) {
      return;
    }
  }
}

}  // namespace

void bench_tracking(int lines) {
  for (const testing::LineArm& arm : testing::kLineArms) {
    const RobotPtr robot = RobotModel::make(load_description(arm.name));
    for (const bool through : {true, false}) {
      Tally tally;
      for (int seed = 0; seed < std::max(1, lines / 2); ++seed) {
        follow(*robot, arm, through, seed, tally);
      }
      JsonLine("tracking", std::string(arm.name) + (through ? ", through singular" : ", anywhere"))
          .add("lines", std::max(1, lines / 2))
          .add("followed", tally.followed)
          .add("failed_steps", tally.failed)
          .add("jumps", tally.jumps)
          .add("must_change_branch", tally.changes)
          .add("of_these_only_quick", tally.quick)
          .add("by_nearest_alone", tally.by_nearest)
          .add("worst_error", tally.worst);
    }
  }
}

}  // namespace viapoint::bench
