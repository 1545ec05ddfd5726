/// @file
/// What a robot file says, in one form for D-H tables, joint axes and URDF.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

/// A robot as data: built by the readers below, checked, and turned into a RobotModel.
struct RobotDescription {
  std::string name;
  std::string title;                      ///< one line for people
  std::vector<std::string> joint_names;
  std::vector<ChainJoint> chain;
  Pose flange = Pose::Identity();         ///< last joint's frame to flange
  Pose tool = Pose::Identity();           ///< flange to tool (TCP)
  JointLimits limits;
  std::vector<std::string> sources;       ///< where the numbers come from
  std::vector<std::string> chosen;        ///< the numbers nobody publishes, and why these
};

/// Reads a robot: a built-in name ("puma560"), or a path that ends in .yaml or .urdf. Built-in
/// descriptions are searched in $VIAPOINT_ROBOTS, beside the installed library, and in the source
/// tree, in that order.
/// @throws MotionError(kBadRobot) with file, line or key, and what was expected; kFile
[[nodiscard]] RobotDescription load_description(const std::string& name_or_path);
/// YAML text, as a file would hold it; `source` names it in errors.
[[nodiscard]] RobotDescription description_from_yaml(const std::string& text,
                                                     const std::string& source);
/// URDF text: the chain from the root link to `tip` (the only leaf when empty). URDF has no
/// acceleration and jerk limits: they are chosen as 10 v and 100 v, and marked as chosen.
[[nodiscard]] RobotDescription description_from_urdf(const std::string& text,
                                                     const std::string& source,
                                                     const std::string& tip = "");
/// The description as YAML that reads back to the same numbers to the last bit.
[[nodiscard]] std::string to_yaml(const RobotDescription& description);
/// Names of the built-in robots, sorted.
[[nodiscard]] std::vector<std::string> builtin_robots();

}  // namespace viapoint
