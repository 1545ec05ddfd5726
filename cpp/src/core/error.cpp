#include "viapoint/core/error.hpp"

#include <array>
#include <sstream>
#include <utility>

namespace viapoint {
namespace {

struct Name {
  ErrorCode code;
  std::string_view text;
};

constexpr std::array kNames{
    Name{ErrorCode::kBadArgument, "bad_argument"},
    Name{ErrorCode::kBadLimits, "bad_limits"},
    Name{ErrorCode::kBadRobot, "bad_robot"},
    Name{ErrorCode::kBadProgram, "bad_program"},
    Name{ErrorCode::kEmptyProgram, "empty_program"},
    Name{ErrorCode::kNotARotation, "not_a_rotation"},
    Name{ErrorCode::kUnreachable, "unreachable"},
    Name{ErrorCode::kOutsideLimits, "outside_limits"},
    Name{ErrorCode::kJointLimit, "joint_limit"},
    Name{ErrorCode::kCouplingLimit, "coupling_limit"},
    Name{ErrorCode::kVelocityLimit, "velocity_limit"},
    Name{ErrorCode::kAccelerationLimit, "acceleration_limit"},
    Name{ErrorCode::kJerkLimit, "jerk_limit"},
    Name{ErrorCode::kSingular, "singular"},
    Name{ErrorCode::kBranchChange, "branch_change"},
    Name{ErrorCode::kUncontrolled, "uncontrolled"},
    Name{ErrorCode::kHalfTurn, "half_turn"},
    Name{ErrorCode::kDegenerateCurve, "degenerate_curve"},
    Name{ErrorCode::kDegeneratePoints, "degenerate_points"},
    Name{ErrorCode::kZeroLength, "zero_length"},
    Name{ErrorCode::kZoneShrunk, "zone_shrunk"},
    Name{ErrorCode::kZoneIsStop, "zone_is_stop"},
    Name{ErrorCode::kPoseCorrected, "pose_corrected"},
    Name{ErrorCode::kNotAtStart, "not_at_start"},
    Name{ErrorCode::kNotAtRest, "not_at_rest"},
    Name{ErrorCode::kDiscontinuous, "discontinuous"},
    Name{ErrorCode::kDriveFault, "drive_fault"},
    Name{ErrorCode::kStopped, "stopped"},
    Name{ErrorCode::kInputTimeout, "input_timeout"},
    Name{ErrorCode::kBusy, "busy"},
    Name{ErrorCode::kFile, "file"},
    Name{ErrorCode::kInternal, "internal"},
};

}  // namespace

std::string_view to_string(ErrorCode code) {
  for (const Name& name : kNames) {
    if (name.code == code) return name.text;
  }
  return "unknown";
}

std::string Problem::describe() const {
  std::ostringstream text;
  if (!file.empty()) {
    text << file;
    if (line) text << ':' << *line;
    text << ": ";
  } else if (line) {
    text << "line " << *line << ": ";
  }
  text << message;
  for (const std::string& way : ways_out) text << "\n  way out: " << way;
  return text.str();
}

MotionError::MotionError(Problem problem)
    : std::runtime_error(problem.describe()), problem_(std::move(problem)) {}

MotionError::MotionError(ErrorCode code, std::string message, std::vector<std::string> ways_out)
    : MotionError([&] {
        Problem problem;
        problem.code = code;
        problem.message = std::move(message);
        problem.ways_out = std::move(ways_out);
        return problem;
      }()) {}

}  // namespace viapoint
