/// @file
/// Runs a proven motion slower, and changes how much slower, within every joint's limits.
///
/// The motion is q(τ) in nominal time τ and keeps every limit at τ = t. It runs in real time t at
/// the rate ρ = dτ/dt in [0, 1]; with α = dρ/dt and γ = dα/dt the joints see
///   q̇ = q'ρ,   q̈ = q''ρ² + q'α,   q⃛ = q'''ρ³ + 3q''ρα + q'γ,
/// with primes by τ. From this follow the two facts everything here rests on:
///   - wherever α = γ = 0 all limits hold, for ever: ρ <= 1 only makes each term smaller;
///   - so a change of ρ is safe when it is known to come back to α = 0 within the limits.
/// Each cycle the governor seeks the strongest push γ toward the wanted rate for which it can prove
/// such a way back: cycle by cycle, over bounds on q', q'', q''' there (Lookahead), with interval
/// arithmetic, so between the cycles too; where those are not known yet, it proves nothing. It
/// commits to push and way back together, and where it finds no better push it follows the way back
/// it has. A proven continuation exists at every moment, whatever is commanded. The way back also
/// tells the rate it ends at, so the push that makes it end exactly at the wanted rate is found by
/// the same search (PushSearch). What is kept are the joints' own limits: a planned tool speed is
/// never exceeded either (ρ <= 1), a planned tool acceleration or a move's scale may be while the
/// rate changes. (The look-ahead of Dahl & Nielsen 1990 and its followers, which scale the path
/// speed on-line, with a proof in place of a guess, and for the jerk.)
#pragma once

#include <algorithm>
#include <array>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/lookahead.hpp"
#include "viapoint/realtime/push_search.hpp"
#include "viapoint/realtime/rate_limits.hpp"

namespace viapoint {

/// Where on the motion, and how fast through it.
struct RateState {
  double tau = 0.0;    ///< nominal time [s]
  double rate = 1.0;   ///< ρ = dτ/dt, in [0, 1]
  double slope = 0.0;  ///< α = dρ/dt [1/s]

  /// After `time` [s] at a constant γ = `curvature` [1/s²].
  [[nodiscard]] RateState after(double time, double curvature) const noexcept VIAPOINT_NONBLOCKING {
    return {tau + time * (rate + time * (0.5 * slope + time * (1.0 / 6.0) * curvature)),
            rate + time * (slope + time * 0.5 * curvature), slope + time * curvature};
  }
};

/// The search described above. Real-time: all but the constructor is safe, and bounded in time
/// whatever the motion. Threads: one.
class RateGovernor {
 public:
  /// @param cycle [s], > 0
  RateGovernor(const JointLimits& limits, double cycle);

  /// Width of the look-ahead's cells that goes with the limits and the cycle [s].
  [[nodiscard]] double cell() const noexcept;
  /// Forgets any plan: the motion now runs at a constant rate.
  void reset() noexcept VIAPOINT_NONBLOCKING;
  /// True while the rate changes.
  [[nodiscard]] bool changing() const noexcept { return plan_.position < plan_.steps; }
  /// Nominal time at which the change under way is over [s]; `now` where there is none. What comes
  /// after it may still become another motion.
  [[nodiscard]] double settled_at(const RateState& now) const noexcept VIAPOINT_NONBLOCKING;
  /// State in `time` [s], if nothing else is decided until then.
  [[nodiscard]] RateState after(const RateState& now,
                                double time) const noexcept VIAPOINT_NONBLOCKING;
  /// Time until nominal time `tau` > now.tau [s] if nothing else is decided until then; infinity
  /// where the rate is 0 before. Within a step of the plan it is told by its mean rate.
  [[nodiscard]] double time_to(const RateState& now,
                               double tau) const noexcept VIAPOINT_NONBLOCKING;
  /// Decides to go on as decided before: γ [1/s²] for the cycle that begins now.
  [[nodiscard]] double keep() const noexcept;
  /// Decides γ [1/s²] for the cycle that begins at `now`, on the way to the rate `target`.
  [[nodiscard]] double decide(const RateState& now, double target,
                              const Lookahead& lookahead) noexcept VIAPOINT_NONBLOCKING;
  /// State one cycle on, under what decide() chose. The end of a change is exact: slope 0.
  [[nodiscard]] RateState advance(const RateState& now) noexcept VIAPOINT_NONBLOCKING;

 private:
  /// Steps that a way back may have, and stretches that all the trials of a cycle may look at
  /// together: what bounds the tick. One whole way back is always within it.
  static constexpr int kSteps = 26;
  static constexpr int kStretchesACycle = kSteps + 2;
  struct Step {
    double curvature = 0.0;
    int cycles = 0;
  };
  /// A push and its way back to slope 0.
  struct Plan {
    std::array<Step, kSteps + 1> step;
    int steps = 0;
    int position = 0;       ///< step under way
    double end_rate = 1.0;  ///< rate where the slope is back at 0
  };
  /// What came of the search for a way back.
  enum class Outcome {
    kProven,
    kTooFar,  ///< the limits are kept, but the rate leaves [0, 1]
    kNone,
  };

  void improve(const RateState& now, double target,
               const Lookahead& lookahead) noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] bool strongest_push(const RateState& now, double wanted, const Lookahead& lookahead,
                                    double& push) noexcept VIAPOINT_NONBLOCKING;
  /// Fills in trial_. @param left stretches that may be looked at still
  [[nodiscard]] Outcome prove(RateState state, double push, const Lookahead& lookahead,
                              int& left) noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] bool step_back(RateState& state,
                               const Lookahead& lookahead) noexcept VIAPOINT_NONBLOCKING;
  /// Short at first, where the next cycles will follow it; long where it only has to be there.
  [[nodiscard]] int longest_step(int step) const noexcept {
    return stride_ << std::min(3, step / 6);
  }

  RateLimits limits_;
  double cycle_;
  int stride_;        ///< cycles in the first steps of the way back
  double max_slope_;  ///< |α| where the joints would allow more [1/s]
  double max_curvature_;
  double wanted_ = 1.0;
  PushSearch::Memory memory_;
  Plan plan_;
  Plan trial_;
  RateStretch stretch_;  ///< a member, so that it is not cleared for every one that is looked at
};

}  // namespace viapoint
