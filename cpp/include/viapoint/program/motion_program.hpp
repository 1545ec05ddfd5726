/// @file
/// A motion program as data: moves, waits and outputs, in order. It knows nothing of kinematics:
/// what it asks for is checked by the planner.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/core/joint_vector.hpp"
#include "viapoint/core/pose.hpp"
#include "viapoint/core/zone.hpp"

namespace viapoint {

/// Where a move goes: joints, a full pose_base_tool, or a tool position alone.
struct JointTarget {
  JointVector q;
};
struct PoseTarget {
  Pose pose_base_tool;
  double correction = 0.0;  ///< CheckedPose::correction of the matrix it was given as
};
struct PositionTarget {
  Eigen::Vector3d position;
};
using Target = std::variant<JointTarget, PoseTarget, PositionTarget>;

/// What a straight line does with the tool's orientation.
enum class Orientation {
  kLeast,  ///< least rotation between the two poses
  kWrist,  ///< wrist joints interpolated, tool position straight
  kFixed,  ///< stays as it is at the start; the target's is not used
};

/// Straight in joint space. A pose or position target takes the branch nearest to where the move
/// begins.
struct PtpMove {
  Target target;
};
/// Straight line of the tool point. A PositionTarget leaves the orientation free (for arms that
/// cannot hold it). A JointTarget means its pose, and its branch must be the one arrived on.
struct LinMove {
  Target target;
  Orientation orientation = Orientation::kLeast;
};
struct Wait {
  double seconds = 0.0;
};
struct SetOutput {
  int index = 0;
  bool value = false;
};
/// The classic fixed-time form (textbook §3): segments of given duration between points, quartic
/// transitions of ±t_acc about the inner ones. Stands alone in its program; starts at speed.
struct TimedPoint {
  Target target;
  double seconds = 0.0;  ///< time from the point before; 0 for the first
};
enum class TimedSpace { kJoint, kCartesian };
struct TimedMove {
  std::vector<TimedPoint> points;
  double t_acc = 0.2;
  TimedSpace space = TimedSpace::kJoint;
};

/// Wishes of one move; what is not given is bounded by the joint limits alone.
struct MoveOptions {
  std::optional<double> speed;         ///< tool [m/s], Cartesian moves
  std::optional<double> acceleration;  ///< tool [m/s²], Cartesian moves
  std::optional<double> scale;         ///< share of all joint limits, (0, 1]
  Zone zone;
};

struct SourceLine {
  std::string file;
  int line = 0;  ///< from 1; 0 where unknown
};

struct Step {
  std::variant<PtpMove, LinMove, Wait, SetOutput, TimedMove> what;
  MoveOptions options;
  SourceLine source;
};

/// How far the tool may be from the straight line it was told, outside zones.
struct LineTolerance {
  double position = 5e-5;                ///< [m]
  double angle = 1.7453292519943296e-4;  ///< [rad] (0.01°)
};

/// Finer than this a tolerance drowns in rounding [m, rad].
inline constexpr double kFinestTolerance = 1e-8;

struct MotionProgram {
  std::string robot;              ///< name of the robot it was written for
  std::string robot_fingerprint;  ///< RobotModel::fingerprint(); empty: any
  JointVector start;              ///< joints where it begins [rad or m], (n,)
  LineTolerance tolerance;        ///< of its straight lines
  std::vector<Step> steps;
};

/// JSON text of a program; numbers read back to the last bit.
[[nodiscard]] std::string to_json(const MotionProgram& program);
/// @throws MotionError(kBadProgram) naming `source`, the key and what was expected
[[nodiscard]] MotionProgram program_from_json(const std::string& text, const std::string& source);
/// Written aside, fsynced and renamed: a reader sees the old file or the new one, never a part.
/// @throws MotionError(kFile)
void save_program(const MotionProgram& program, const std::string& path);
[[nodiscard]] MotionProgram load_program(const std::string& path);

}  // namespace viapoint
