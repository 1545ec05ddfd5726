/// @file
/// One axis' way from state to state: the quickest, those of a given duration, and which durations
/// there are. Position limits are left aside here.
///
/// What is gained in a fixed time T is an interval [least(T), most(T)]: the limits are convex and
/// the dynamics linear. `most` belongs to the upward family, `least` to the upward family of the
/// mirrored axis, and what lies between to convex combinations of the two.
#pragma once

#include "profile/phase_chain.hpp"
#include "profile/rest_motion.hpp"
#include "profile/upward_family.hpp"
#include "viapoint/profile/axis_move.hpp"

namespace viapoint {

class AxisProblem {
 public:
  /// Takes the problem in; the motion back inside the limits is appended to `move`, which starts
  /// at `start`. Real-time: safe.
  [[nodiscard]] MoveStatus set(const AxisState& start, const AxisState& end,
                               const AxisLimits& limits, AxisMove& move) noexcept;

  /// Solves for the quickest motion. @return its duration, counted from the start
  double solve_quickest() noexcept;
  /// The quickest motion, appended. @pre solve_quickest
  void append_quickest(AxisMove& move) const noexcept;
  /// The quickest motion to the end's velocity and acceleration, appended.
  void append_velocity_change(AxisMove& move) noexcept;

  /// The shortest duration not under `duration` that some motion has, counted from the start.
  /// @pre `duration` not under that of the quickest
  [[nodiscard]] double next_duration(double duration) noexcept;
  /// A motion that lasts `duration`, appended. @pre next_duration returned it
  void append_lasting(double duration, AxisMove& move) noexcept;
  /// From rest to rest, and nothing to come back from: the quickest can be slowed down to any.
  [[nodiscard]] bool is_rest_to_rest() const noexcept { return rests_; }

 private:
  [[nodiscard]] UpwardLimits limits_of(bool upward) const noexcept;
  void build(bool upward) noexcept;
  [[nodiscard]] PhaseChain chain_of(bool upward, const UpwardMember& member) const noexcept;
  void append_slowed(double duration, AxisMove& move) const noexcept;
  void solve_lasting(double t) noexcept;

  AxisLimits limits_;
  AxisState from_, to_;  ///< inside the limits; to_.q counts from from_.q
  double target_q_;
  double position_rounding_;
  double brake_time_;
  bool rests_;  ///< at the start and at the end: then all is in the next two
  bool stays_;
  RestMotion rest_motion_;  ///< `quickest_` has its duration only
  UpwardFamily up_, down_;
  bool has_up_, has_down_;
  UpwardMember quickest_;
  bool quickest_is_upward_;
  double lasting_;  ///< the duration, after the brake, that most_ and least_ last
  UpwardMember most_, least_;
};

}  // namespace viapoint
