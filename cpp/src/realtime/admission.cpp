#include <sstream>

#include "viapoint/core/error.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {
namespace {

/// How far from its first point the arm may rest [rad or m].
constexpr double kStartTolerance = 1e-6;

void check_start(const JointVector& first, const JointVector& position) {
  for (int i = 0; i < position.size(); ++i) {
    const double away = std::abs(position[i] - first[i]);
    if (away <= kStartTolerance) continue;
    std::ostringstream text;
    text << "joint " << i + 1 << " rests at " << position[i] << ", " << away
         << " from where the motion starts (" << first[i] << "); allowed is " << kStartTolerance
         << " rad or m";
    Problem problem;
    problem.code = ErrorCode::kNotAtStart;
    problem.message = text.str();
    problem.ways_out = {"move the arm to the motion's first point first",
                        "start the program where the arm rests"};
    problem.joint = i;
    problem.time = 0.0;
    problem.value = position[i];
    problem.limit = first[i];
    throw MotionError(problem);
  }
}

}  // namespace

void admit(const Trajectory& trajectory, const JointLimits& limits, const JointVector& position) {
  if (trajectory.pieces().empty()) {
    throw MotionError(ErrorCode::kEmptyProgram, "the motion is empty: there is nothing to run",
                      {"add a move to the program"});
  }
  if (trajectory.joints() != limits.joints() || position.size() != limits.joints()) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the motion has " + std::to_string(trajectory.joints()) +
                          " joints, the arm has " + std::to_string(limits.joints()) +
                          " limits and " + std::to_string(position.size()) + " positions",
                      {"plan the program for the arm that is to run it"});
  }
  const Certificate certificate = certify(trajectory.pieces(), limits);
  if (!certificate.holds()) throw MotionError(certificate.problems.front());
  check_start(trajectory.at(0.0).q, position);
}

}  // namespace viapoint
