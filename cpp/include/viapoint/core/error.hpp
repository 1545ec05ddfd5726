/// @file
/// One family of errors. A `Problem` says what is wrong, where, and what would make it right; a
/// `MotionError` is a Problem thrown. Real-time code throws neither: it returns a status enum.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace viapoint {

/// What went wrong. Python has one exception class a code, all derived from viapoint.MotionError.
enum class ErrorCode {
  kBadArgument,        ///< wrong type, size, sign, NaN or infinity
  kBadLimits,          ///< limits of zero, swapped, or missing
  kBadRobot,           ///< a robot description that cannot be read
  kBadProgram,         ///< a program or point file that cannot be read
  kEmptyProgram,       ///< nothing to do
  kNotARotation,       ///< a pose whose 3x3 block is no rotation
  kUnreachable,        ///< the pose is outside the arm's reach
  kOutsideLimits,      ///< reachable, but on no branch within the joint limits
  kJointLimit,         ///< a joint leaves its position limits
  kCouplingLimit,      ///< a coupled limit is left
  kVelocityLimit,      ///< a joint is too fast
  kAccelerationLimit,  ///< a joint accelerates too much
  kJerkLimit,          ///< a joint's jerk is too large
  kSingular,           ///< the arm is at or too near a singularity
  kBranchChange,       ///< start and goal are reachable only on different branches
  kUncontrolled,       ///< the arm has too few joints to hold every coordinate asked for
  kHalfTurn,           ///< orientations 180° apart: the least rotation is not unique
  kDegenerateCurve,    ///< points that define no curve (an arc's on one line), or one with a cusp
  kDegeneratePoints,   ///< touched points too alike to tell the tool or frame that is asked for
  kZeroLength,         ///< a move that goes nowhere (warning: it is left out)
  kZoneShrunk,         ///< a zone larger than its legs allow (warning)
  kZoneIsStop,         ///< a corner where stopping is quicker, or a near reversal (warning)
  kPoseCorrected,      ///< a pose within rounding of a rotation was projected (warning)
  kNotAtStart,         ///< the arm is not where the motion starts
  kNotAtRest,          ///< the motion starts or ends at speed
  kDiscontinuous,      ///< pieces that do not meet
  kDriveFault,         ///< the drive refused or failed
  kStopped,            ///< the run was stopped before its end
  kInputTimeout,       ///< an input that the program waits for did not come in time
  kBusy,               ///< a run is already under way
  kFile,               ///< a file that cannot be read or written
  kInternal,           ///< a defect of viapoint itself
};

/// Stable lower-case name, e.g. "joint_limit".
[[nodiscard]] std::string_view to_string(ErrorCode code);

enum class Severity { kWarning, kError };

/// One thing that is wrong. Fields that do not apply stay empty.
struct Problem {
  Severity severity = Severity::kError;
  ErrorCode code = ErrorCode::kInternal;
  std::string message;                ///< what was wrong and the allowed range, one sentence
  std::vector<std::string> ways_out;  ///< what would make it right, each a sentence
  std::optional<int> move;            ///< index of the move in its program, from 0
  std::string file;                   ///< source of the move, or the file that was read
  std::optional<int> line;            ///< line in `file`, from 1
  std::optional<int> joint;           ///< joint, from 0
  std::optional<double> time;         ///< [s] from the motion's start
  std::optional<double> share;        ///< share of the leg where it happens, 0..1
  std::optional<double> value;        ///< the offending value [SI, rad]
  std::optional<double> limit;        ///< what it was held against [SI, rad]

  /// The whole in one text: where, what, ways out.
  [[nodiscard]] std::string describe() const;
};

/// The one exception of the library, outside the real-time part.
class MotionError : public std::runtime_error {
 public:
  explicit MotionError(Problem problem);
  MotionError(ErrorCode code, std::string message, std::vector<std::string> ways_out = {});

  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] ErrorCode code() const { return problem_.code; }

 private:
  Problem problem_;
};

}  // namespace viapoint
