#include "viapoint/profile/axis_move.hpp"

#include <algorithm>

#include "profile/constant_jerk.hpp"
#include "profile/move_problem.hpp"

namespace viapoint {

std::string_view to_string(MoveStatus status) noexcept {
  switch (status) {
    case MoveStatus::kSolved:
      return "solved";
    case MoveStatus::kBadLimits:
      return "every minimum must be negative, every maximum positive, both finite; those of the "
             "position must be in order";
    case MoveStatus::kBadState:
      return "start and end must be finite";
    case MoveStatus::kEndVelocity:
      return "the end velocity is outside its limits";
    case MoveStatus::kEndAcceleration:
      return "the end acceleration is outside its limits";
    case MoveStatus::kEndUnreachable:
      return "the end acceleration can only be arrived at from a velocity outside its limits";
    case MoveStatus::kDurationImpossible:
      return "no motion within the limits lasts exactly that long";
    case MoveStatus::kNotParallel:
      return "start or end do not move along the straight line between them";
    case MoveStatus::kBadSize:
      return "start, end and limits must have the same number of joints, 1 to 16";
    case MoveStatus::kEndPosition:
      return "the end is outside the position limits";
    case MoveStatus::kStartTooFast:
      return "the start moves too fast toward a position limit to stop before it";
    case MoveStatus::kEndTooFast:
      return "the end can only be arrived at from beyond a position limit";
    case MoveStatus::kNoRoom:
      return "the position limits leave too little room for the motion";
  }
  return "unknown status";
}

AxisState AxisMove::at(double t) const noexcept VIAPOINT_NONBLOCKING {
  if (phases == 0 || t >= total) return end;
  if (!(t > 0.0)) return phase[0].from;
  size_t i = 0;
  for (; static_cast<int>(i) + 1 < phases && t >= phase[i].duration; ++i) t -= phase[i].duration;
  return advanced(phase[i].from, phase[i].from.qddd, std::min(t, phase[i].duration));
}

void AxisMove::begin(const AxisState& start) noexcept {
  phases = 0;
  total = 0.0;
  end = {start.q, start.qd, start.qdd, 0.0};
}

void AxisMove::append(double jerk, double seconds) noexcept {
  if (!(seconds > 0.0)) return;
  const AxisState next = advanced(end, jerk, seconds);
  if (phases > 0 && phase[static_cast<size_t>(phases - 1)].from.qddd == jerk) {
    phase[static_cast<size_t>(phases - 1)].duration += seconds;
  } else {
    phase[static_cast<size_t>(phases)] = {seconds, {end.q, end.qd, end.qdd, jerk}};
    ++phases;
  }
  total += seconds;
  end = {next.q, next.qd, next.qdd, 0.0};
}

MoveStatus quickest_move(const AxisState& start, const AxisState& end, const AxisLimits& limits,
                         AxisMove& move) noexcept VIAPOINT_NONBLOCKING {
  MoveProblem problem;
  const MoveStatus status = problem.solve(start, end, limits, move);
  if (status != MoveStatus::kSolved) return status;
  return problem.append_quickest(move) ? status : MoveStatus::kNoRoom;
}

MoveStatus quickest_velocity_change(const AxisState& start, const AxisState& end,
                                    const AxisLimits& limits,
                                    AxisMove& move) noexcept VIAPOINT_NONBLOCKING {
  AxisState there = end;
  there.q = start.q;
  AxisProblem problem;
  const MoveStatus status = problem.set(start, there, limits, move);
  if (status == MoveStatus::kSolved) problem.append_velocity_change(move);
  return status;
}

}  // namespace viapoint
