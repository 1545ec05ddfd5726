/// @file
/// The way back to where a path was left.
#pragma once

#include <cstdint>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/nonblocking.hpp"
#include "viapoint/profile/axis_move.hpp"
#include "viapoint/realtime/drive.hpp"

namespace viapoint {

/// From rest to rest along the straight line q = from + s Δ in joint space, s by the quickest law
/// (AxisMove) under the limits that the joints leave s: each of theirs over |Δ|, the least of all.
/// So every joint keeps velocity, acceleration and jerk; and what both ends keep of positions and
/// coupled limits the whole line keeps, because it is convex. The law is made anew where the
/// share of the speed changes, from the state that the last one has reached.
///
/// Real-time: all but the constructor is safe; a cycle costs a law at most. Threads: one.
class PathReturn {
 public:
  /// @param cycle [s], > 0. @pre limits valid
  PathReturn(const JointLimits& limits, double cycle);

  /// Takes a line from where the arm rests. Where the ends are the same it has arrived.
  void begin(const JointVector& from, const JointVector& to) noexcept VIAPOINT_NONBLOCKING;
  /// One cycle on, at `share` of the velocity limits, 0 to rest on the line. Fills in the setpoint,
  /// all but cycle and outputs. @pre active()
  void tick(double share, Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  /// True from begin() on until drop().
  [[nodiscard]] bool active() const noexcept { return active_; }
  /// Forgets the line. @pre rests()
  void drop() noexcept VIAPOINT_NONBLOCKING { active_ = false; }
  /// Of the last tick: at the line's end, exactly and at rest; and at rest, there or on the way.
  [[nodiscard]] bool arrived() const noexcept { return arrived_; }
  [[nodiscard]] bool rests() const noexcept { return rests_; }

 private:
  void replan(const AxisState& from, double share) noexcept VIAPOINT_NONBLOCKING;

  JointLimits limits_;
  double cycle_;
  JointVector from_, to_, step_;
  double velocity_ = 0.0, acceleration_ = 0.0, jerk_ = 0.0;  ///< limits of s
  AxisMove law_;
  std::uint64_t cycles_ = 0;  ///< since the law began
  double share_ = 0.0;        ///< that the law is for
  bool active_ = false, arrived_ = false, rests_ = true;
};

}  // namespace viapoint
