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
  std::string title;  ///< one line for people
  std::vector<std::string> joint_names;
  std::vector<ChainJoint> chain;
  /// Where the arm stands: its base seen from the frame that every pose is told in ("base frame").
  Pose base = Pose::Identity();
  Pose flange = Pose::Identity();  ///< last joint's frame to flange
  Pose tool = Pose::Identity();    ///< flange to tool (TCP)
  JointLimits limits;
  std::vector<std::string> sources;  ///< where the numbers come from
  std::vector<std::string> chosen;   ///< the numbers nobody publishes, and why these
};

/// Reads a robot: a built-in name ("puma560"), or a path that ends in .yaml or .urdf. Built-in
/// descriptions are searched in $VIAPOINT_ROBOTS, in the directory of set_robot_directory(), in
/// share/viapoint/robots beside the bin/ of the running executable, and in the source tree, in that
/// order. Real-time: not. Threads: any.
/// @param tip link of a URDF that carries the tool; the only leaf that moves when empty
/// @throws MotionError(kBadRobot) with file, line or key, and what was expected; kBadLimits for
/// limits that are missing, zero or swapped; kFile
[[nodiscard]] RobotDescription load_description(const std::string& name_or_path,
                                                const std::string& tip = "");
/// Where load_description() and builtin_robots() look besides: for packages that carry the
/// descriptions elsewhere. Threads: any.
void set_robot_directory(const std::filesystem::path& directory);
/// YAML text, as a file would hold it; `source` names it in errors. The keys:
///   name, title, units: {angle: deg | rad} (every angle in the file), axes: number of joints,
///   dh: standard | modified (each joint: d, a, alpha, and theta, its offset), or without dh each
///   joint an origin: {xyz, rpy or rotation} and an axis, or kinematics: none,
///   base, flange, tool: {xyz, rpy or rotation}, coupling: {matrix, lower, upper}, sources, chosen,
///   joints: list of {name, type, ..., position: [min, max], velocity, acceleration, jerk}.
/// Lengths are in metres. `joints` comes last, each in braces, and `axes` tells how many: so a file
/// cut short anywhere is refused. A file holds one document.
/// @throws MotionError(kBadRobot, kBadLimits) with line and key
[[nodiscard]] RobotDescription description_from_yaml(const std::string& text,
                                                     const std::string& source);
/// URDF text: the chain from the root link to `tip` (the only leaf that moves when empty). URDF
/// has no acceleration and jerk limits: they are chosen as 10 v and 100 v, and marked as chosen.
/// @throws MotionError(kBadRobot, kBadLimits) naming the joint or link
[[nodiscard]] RobotDescription description_from_urdf(const std::string& text,
                                                     const std::string& source,
                                                     const std::string& tip = "");
/// The description as YAML (joint axes, rad) that reads back to the same numbers to the last bit.
[[nodiscard]] std::string to_yaml(const RobotDescription& description);
/// Names of the built-in robots, sorted.
[[nodiscard]] std::vector<std::string> builtin_robots();

}  // namespace viapoint
