/// @file
/// Hold-to-run without a clock, for scripts that are tried before they move anything.
#pragma once

#include <chrono>
#include <string>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {

/// What keeps a jog from doing what is wished, for the operator; empty where nothing does.
[[nodiscard]] std::string text_of(const JogBlock& block);

/// Jogs an Interpolator whose time passes only when told. Real-time: no. Threads: one.
class VirtualJog {
 public:
  /// @param start where the arm rests, (n,)
  /// @throws MotionError(kBadArgument) for another number of joints, or a cycle that is not
  /// positive
  VirtualJog(const JointLimits& limits, const JointVector& start, std::chrono::nanoseconds cycle);

  /// As ControllerLoop::jog. @throws MotionError(kBadArgument, kVelocityLimit)
  void jog(const JointVector& velocity);
  /// Lets so many cycles pass, or fewer: until the arm rests.
  void pass(int cycles);

  [[nodiscard]] const JointVector& position() const noexcept { return position_; }
  [[nodiscard]] bool jogging() const noexcept { return interpolator_.jogging(); }
  [[nodiscard]] std::string block() const { return text_of(interpolator_.jog_block()); }

 private:
  JointLimits limits_;
  JointVector position_;
  Interpolator interpolator_;
};

}  // namespace viapoint
