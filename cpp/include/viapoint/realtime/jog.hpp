/// @file
/// Hold-to-run: joints that turn at a wished velocity for as long as the wish is renewed.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/nonblocking.hpp"
#include "viapoint/profile/axis_move.hpp"
#include "viapoint/realtime/drive.hpp"

namespace viapoint {

/// What keeps a jog from doing what is wished.
struct JogBlock {
  enum class Kind : std::uint8_t {
    kNone,
    kPositionLimit,  ///< a joint is at its position limit, or slows down toward it
    kCouplingLimit,  ///< the arm stopped before a coupled limit
  };
  Kind kind = Kind::kNone;
  int index = -1;  ///< joint, or row of the coupling
};

/// What keeps a jog from doing what is wished, for the operator; empty where nothing does.
[[nodiscard]] std::string text_of(const JogBlock& block);

/// Each joint on its own: the quickest law (AxisMove) to the wished velocity or, where a position
/// limit lies that way, to rest at that limit with the wished velocity as its speed limit, so that
/// the joint stops there by itself. A law is made anew only where the wish has changed, from the
/// state that the last one has reached. Coupled limits are held by looking ahead: a cycle is taken
/// only if the arm, after it, could still stop before each of them; or else it stops now, which the
/// cycle before has shown to be possible. Outside a limit already, a jog may not go farther out.
///
/// Real-time: all but the constructor is safe; a cycle costs O(joints) laws at most. Threads: one.
class Jog {
 public:
  /// @param cycle [s], > 0. @pre limits valid
  Jog(const JointLimits& limits, double cycle);

  /// Wishes velocities (n,) [rad/s or m/s] for the next `cycles`; clamped to the limits, 0 stops.
  /// @param position where the arm rests, used where no jog is under way
  void wish(const JointVector& velocity, int cycles,
            const JointVector& position) noexcept VIAPOINT_NONBLOCKING;
  /// True until all joints rest and nothing is wished any more.
  [[nodiscard]] bool active() const noexcept { return active_; }
  /// Drops the motion on the spot, for a drive that has failed.
  void abandon() noexcept VIAPOINT_NONBLOCKING { active_ = false; }
  /// One cycle: fills in the setpoint due now, all but cycle and outputs. @pre active()
  void tick(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] JogBlock block() const noexcept { return block_; }

 private:
  struct Axis {
    AxisMove law;
    std::uint64_t cycles;  ///< since it began
    double wished;         ///< velocity [rad/s or m/s]
    double followed;       ///< what the law is for
  };

  void replan(int joint, bool stop) noexcept VIAPOINT_NONBLOCKING;
  void stop_all() noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] AxisState state_of(const Axis& axis,
                                   std::uint64_t cycles) const noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] bool may_go_on() noexcept VIAPOINT_NONBLOCKING;
  void find_block() noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] AxisLimits limits_of(int joint) const noexcept VIAPOINT_NONBLOCKING;

  JointLimits limits_;
  double cycle_;
  std::array<Axis, kMaxJoints> axes_;
  CouplingVector lower_, upper_;  ///< the coupled limits, wider where the jog began outside
  bool active_ = false;
  bool is_stopped_ = false;  ///< before a coupled limit, until another direction is wished
  int lease_ = 0;            ///< cycles left
  JogBlock block_;
};

}  // namespace viapoint
