#include "viapoint/realtime/virtual_jog.hpp"

#include <algorithm>

#include "viapoint/core/error.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {

std::string text_of(const JogBlock& block) {
  const std::string index = std::to_string(block.index + 1);
  switch (block.kind) {
    case JogBlock::Kind::kNone:
      break;
    case JogBlock::Kind::kPositionLimit:
      return "joint " + index + " is at its position limit";
    case JogBlock::Kind::kCouplingLimit:
      return "the arm has stopped before its coupled limit " + index;
  }
  return {};
}

VirtualJog::VirtualJog(const JointLimits& limits, const JointVector& start,
                       std::chrono::nanoseconds cycle)
    : limits_(limits),
      position_(start),
      interpolator_(limits, std::max(cycle, std::chrono::nanoseconds(1)), start) {
  if (start.size() != limits.joints() || !start.allFinite() || cycle.count() <= 0) {
    throw MotionError(ErrorCode::kBadArgument,
                      "a jog starts at " + std::to_string(limits.joints()) +
                          " finite joints, and its cycle is longer than nothing");
  }
}

void VirtualJog::jog(const JointVector& velocity) {
  admit_jog(velocity, limits_);
  interpolator_.jog(velocity);
}

void VirtualJog::pass(int cycles) {
  Setpoint setpoint;
  for (int i = 0; i < cycles && interpolator_.jogging(); ++i) {
    interpolator_.tick(setpoint);
    position_ = setpoint.q;
  }
}

}  // namespace viapoint
