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

/// What a Cartesian move does with the tool's orientation.
enum class Orientation {
  kLeast,    ///< least rotation between the poses of start and goal
  kWrist,    ///< wrist joints interpolated, tool position on the curve
  kFixed,    ///< stays as it is at the start; the target's is not used
  kTangent,  ///< turns with the curve's direction, as a nozzle that is led along it
  kThrough,  ///< through the orientation of every point, C²
  kSpin,     ///< the tool's z axis by the least turn to the goal's; free to spin about it
  kFree,     ///< left to the joints: only the position is held
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
/// Circular arc of the tool point from where the move begins through `via` to `target`. `via` is a
/// pose or a position; its orientation counts for Orientation::kThrough only. A PositionTarget as
/// `target` leaves the orientation free.
struct CircMove {
  Target via;
  Target target;
  Orientation orientation = Orientation::kLeast;
};
/// A turn of the tool point about an axis, with a travel of `pitch` [m] along it for every positive
/// turn: an arc, a circle or more, a helix; on its own axis a screw. With kTangent the whole tool
/// turns with it. kLeast and kThrough mean nothing here.
struct TurnMove {
  std::optional<Eigen::Vector3d> center;  ///< point of the axis, base frame [m]; empty: tool point
  std::optional<Eigen::Vector3d> axis;    ///< direction, base frame; empty: z of the tool
  double angle = 0.0;                     ///< about the axis [rad]; any size, either sign
  double pitch = 0.0;                     ///< [m] a turn
  Orientation orientation = Orientation::kFixed;
};
enum class SplineKind {
  kCubic,    ///< natural, C², through the points
  kQuintic,  ///< natural, C⁴, through the points
  kBezier,   ///< by control points, the start being the first; at most 5 more
  kBSpline,  ///< cubic, clamped and uniform, by control points
};
enum class SplineSpace { kTool, kJoint };
/// A smooth curve from where the move begins through (or by) `points`, of the tool or of the
/// joints. In tool space a JointTarget means its pose; PositionTargets leave the orientation free.
/// In joint space a pose takes the branch nearest to the point before.
struct SplineMove {
  std::vector<Target> points;
  SplineKind kind = SplineKind::kCubic;
  SplineSpace space = SplineSpace::kTool;
  Orientation orientation = Orientation::kThrough;  ///< tool space only
  /// Where start and points are passed, rising; empty: by the distances. kCubic and kQuintic only.
  std::vector<double> at;
  /// Where the curve begins, if it has a beginning of its own: the arm must be there.
  std::optional<Target> start;
};
/// From here on poses, positions and axes are told in this frame; those of a new program in the
/// base frame. Joints are what they are, and so is the tool's own z.
struct SetFrame {
  Pose pose_base_frame = Pose::Identity();
  std::string name;
};
/// From here on the arm moves this tool; empty: the robot's own. The arm stops where the tool
/// changes.
struct SetTool {
  std::optional<Pose> pose_flange_tool;
  std::string name;
};
struct Wait {
  double seconds = 0.0;
};
/// The arm rests until a digital input is so.
struct WaitInput {
  int index = 0;  ///< 0 to 63
  bool value = true;
  /// After so long [s] the run ends there; empty: never.
  std::optional<double> timeout;
};
/// A digital output changes where the path has got to, or some way or time from there. Where a
/// corner rounds the point, that is the place on the path that is nearest to it.
struct SetOutput {
  int index = 0;
  bool value = false;
  /// Along the path of the tool, on the move after; negative: on the move before [m].
  double distance = 0.0;
  /// On the clock, after the arm passes that place; negative: before it does [s].
  double time = 0.0;
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
  std::optional<double> angular_speed = std::nullopt;  ///< of the tool [rad/s], Cartesian moves
  std::optional<double> angular_acceleration =
      std::nullopt;  ///< of the tool [rad/s²], Cartesian moves
  /// Tool speed to be kept wherever the limits allow, never more [m/s]; instead of `speed`.
  std::optional<double> process_speed = std::nullopt;
};

struct SourceLine {
  std::string file;
  int line = 0;  ///< from 1; 0 where unknown
};

struct Step {
  std::variant<PtpMove, LinMove, CircMove, TurnMove, SplineMove, Wait, WaitInput, SetOutput,
               TimedMove, SetFrame, SetTool>
      what;
  MoveOptions options;
  SourceLine source;
};

/// How far the tool may be from the line or curve it was told, outside zones.
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
  LineTolerance tolerance;        ///< of its lines and curves
  std::vector<Step> steps;
};

/// The step with everything that it tells in a frame told in the base frame.
[[nodiscard]] Step in_base(Step step, const Pose& pose_base_frame);

/// JSON text of a program; numbers read back to the last bit.
[[nodiscard]] std::string to_json(const MotionProgram& program);
/// @throws MotionError(kBadProgram) naming `source`, the key and what was expected
[[nodiscard]] MotionProgram program_from_json(const std::string& text, const std::string& source);
/// Written aside, fsynced and renamed: a reader sees the old file or the new one, never a part.
/// @throws MotionError(kFile)
void save_program(const MotionProgram& program, const std::string& path);
[[nodiscard]] MotionProgram load_program(const std::string& path);

}  // namespace viapoint
