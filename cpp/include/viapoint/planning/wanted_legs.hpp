/// @file
/// What a program asks of every move, as geometry: what a finished motion is held against by those
/// who do not trust the planner.
#pragma once

#include <memory>
#include <vector>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/path/task_curve.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint {

/// A point that a leg passes so near that it makes no corner.
struct MergedPoint {
  CornerOutcome outcome;
  JointVector at;            ///< as it was told: joints (n,), or the tool point (3,) [m]
  Eigen::Matrix3d rotation;  ///< of the tool there, where the leg holds it
};

/// One move from point to point, before corners and time.
struct WantedLeg {
  RobotPtr robot;                          ///< with the tool that moves here
  int move = 0;                            ///< program step
  JointPath path;                          ///< the whole way in joints, from point to point
  std::shared_ptr<const TaskCurve> curve;  ///< of the tool, over the path's s; null in joint space
  Hold hold = Hold::kPose;                 ///< what of the curve is kept
  MoveOptions options;
  std::vector<MergedPoint> merged;  ///< in order; of a straight leg alone
};

/// The legs of a program in order; none of a timed one, whose motion is what its points say. Walks
/// the whole program anew, as planning does.
/// @throws MotionError: the first error of the report
/// Real-time: not. Threads: any, at once.
[[nodiscard]] std::vector<WantedLeg> wanted_legs(const RobotPtr& robot,
                                                 const MotionProgram& program);

}  // namespace viapoint
