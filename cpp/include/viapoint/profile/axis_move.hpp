/// @file
/// One axis from any position, velocity and acceleration to any other, within limits on velocity,
/// acceleration and jerk that may differ by direction, and on position where there are such.
#pragma once

#include <array>
#include <limits>
#include <string_view>

#include "viapoint/core/nonblocking.hpp"
#include "viapoint/profile/jerk_profile.hpp"

namespace viapoint {

/// Limits of one axis; every minimum is negative, every maximum positive, all finite. Those of the
/// position are any two numbers in order, infinite where there is no limit.
struct AxisLimits {
  double velocity_min = 0.0, velocity_max = 0.0;
  double acceleration_min = 0.0, acceleration_max = 0.0;
  double jerk_min = 0.0, jerk_max = 0.0;
  double position_min = -std::numeric_limits<double>::infinity();
  double position_max = std::numeric_limits<double>::infinity();

  /// The same limits in both directions.
  [[nodiscard]] static constexpr AxisLimits symmetric(double velocity, double acceleration,
                                                      double jerk) noexcept {
    return {-velocity, velocity, -acceleration, acceleration, -jerk, jerk};
  }
};

/// What came of a request.
enum class MoveStatus : unsigned char {
  kSolved,
  kBadLimits,           ///< a minimum that is not negative, a maximum not positive, or not finite
  kBadState,            ///< a start or an end that is not finite
  kEndVelocity,         ///< the end velocity is outside its limits
  kEndAcceleration,     ///< the end acceleration is outside its limits
  kEndUnreachable,      ///< whatever arrives with that acceleration had a velocity outside before
  kDurationImpossible,  ///< no motion within the limits lasts exactly that long
  kNotParallel,         ///< the start or the end does not move along the straight line
  kBadSize,             ///< no joints, more than kMaxJoints, or sizes that differ
  kEndPosition,         ///< the end lies outside the position limits
  kStartTooFast,        ///< the start cannot stop before a position limit
  kEndTooFast,          ///< whatever arrives like that was beyond a position limit before
  kNoRoom,              ///< the position limits leave too little room in between
};

/// The status in words, for messages. Real-time: safe.
[[nodiscard]] std::string_view to_string(MoveStatus status) noexcept;

/// Phases of constant jerk. Each begins from a state of its own, so that a long phase does not
/// carry the rounding of the one before: at rest and on a limit the rates are exact.
/// Real-time: safe. Threads: const methods.
struct AxisMove {
  /// Two to come back inside the limits, and then the switching times of two motions merged, or the
  /// legs from one position limit to another.
  static constexpr int kMaxPhases = 40;

  struct Phase {
    double duration;  ///< [s], > 0
    AxisState from;   ///< qddd is the jerk of the phase
  };

  std::array<Phase, kMaxPhases> phase;  ///< `phases` of them hold values
  int phases = 0;
  AxisState end;       ///< the state aimed for, or the start where nothing moves
  double total = 0.0;  ///< [s]

  /// State at t, clamped to [0, total].
  [[nodiscard]] AxisState at(double t) const noexcept VIAPOINT_NONBLOCKING;
  /// The state that long after the end, for who goes on: at the end's velocity, without
  /// acceleration. @param seconds >= 0
  [[nodiscard]] AxisState after_end(double seconds) const noexcept VIAPOINT_NONBLOCKING {
    return {end.q + seconds * end.qd, end.qd, 0.0, 0.0};
  }
  /// The least and the greatest position; exact.
  struct Extent {
    double low, high;
  };
  [[nodiscard]] Extent extent() const noexcept VIAPOINT_NONBLOCKING;

  /// Empties the motion and puts it at `start`.
  void begin(const AxisState& start) noexcept;
  /// Adds a phase from `end` on; none where `seconds` is zero or, by rounding, less.
  /// @pre phases < kMaxPhases
  void append(double jerk, double seconds) noexcept;
};

/// The quickest motion from `start` to `end` (q, qd, qdd of each; qddd is not read). A start
/// outside the limits first comes back in: the acceleration at full jerk, then the velocity by the
/// quickest motion whose acceleration vanishes on the limit.
/// Exact but for rounding: states meet within 1e-9 of the size of the move, also where limits lie
/// decades apart. Digits are lost where the limits of the two directions differ by a factor of more
/// than 1e4, and where the velocity has to change by less than its own rounding.
/// Position limits hold all the way, to 1e-9 of the size of the move. A start outside them comes in
/// and stays in; it moves farther out only where it is too fast not to, and no farther than the
/// quickest stop would take it. Where the quickest motion touches the limits more than twice, the
/// one found may be slower: it comes to rest in between.
/// @return kSolved, or why there is no such motion; `move` is then left alone
/// Real-time: safe. Threads: none shared.
[[nodiscard]] MoveStatus quickest_move(const AxisState& start, const AxisState& end,
                                       const AxisLimits& limits,
                                       AxisMove& move) noexcept VIAPOINT_NONBLOCKING;

/// The quickest motion to the velocity and acceleration of `end`, wherever that is; end.q is not
/// read, nor are the position limits. What a stop is made of. Otherwise as quickest_move.
[[nodiscard]] MoveStatus quickest_velocity_change(const AxisState& start, const AxisState& end,
                                                  const AxisLimits& limits,
                                                  AxisMove& move) noexcept VIAPOINT_NONBLOCKING;

}  // namespace viapoint
