/// @file
/// A finished motion: pieces in time order and their proof. The one header of this module that
/// real-time code includes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/trajectory/certificate.hpp"
#include "viapoint/trajectory/timed_changes.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// What a stretch of motion does to the digital outputs, bit i for output i.
struct OutputEffect {
  std::uint64_t changed = 0;  ///< those that it sets or clears
  std::uint64_t on = 0;       ///< those that are on after it, of the changed ones
};

/// Whether a motion that is left `left` [s] after this piece begins has begun it: what is shorter
/// than rounding of the piece's duration does not count.
[[nodiscard]] bool begins_before(const TrajectoryPiece& piece, double left);

/// Immutable once built. Threads: any.
class Trajectory {
 public:
  /// The longest motion [s], 30 000 years: beyond, doubles tell cycles no longer well apart, and
  /// motion files hold no such number.
  static constexpr double kMostDuration = 1e12;

  Trajectory() = default;
  /// Certifies against `limits`, from rest or from the state `from`. Limits that are broken do not
  /// throw: they are the certificate's problems.
  /// @throws MotionError(kBadArgument) for no pieces, and for a piece of differing joints, not
  ///   finite, of no duration or with more outputs than it can hold, and for more than
  ///   kMostDuration; kBadLimits
  Trajectory(std::vector<TrajectoryPiece> pieces, const JointLimits& limits,
             const std::optional<JointState>& from = std::nullopt);

  /// This motion without its first `dropped` pieces, left at `leave` [s of this motion] for `next`.
  /// Nothing is proven anew: its certificate is that of `next`. Outputs that are told a time in
  /// either are among timed_changes().
  /// @pre start_of(dropped) < leave; the states agree where the two meet, and the joints too
  [[nodiscard]] Trajectory continued(size_t dropped, double leave, const Trajectory& next) const;

  [[nodiscard]] int joints() const { return pieces_.empty() ? 0 : pieces_.front().joints; }
  [[nodiscard]] double duration() const { return duration_; }
  [[nodiscard]] const std::vector<TrajectoryPiece>& pieces() const { return pieces_; }
  /// Nominal time at which piece i begins [s].
  [[nodiscard]] double start_of(size_t piece) const { return starts_[piece]; }
  /// Time since piece i began, clamped to it [s]; from the end of the motion on all of its
  /// duration, which t - start may miss by an ulp. Real-time: safe, O(1).
  [[nodiscard]] double time_in(size_t piece, double t) const {
    const double whole = pieces_[piece].duration;
    return t >= duration_ ? whole : std::clamp(t - starts_[piece], 0.0, whole);
  }
  /// What the pieces up to and with piece i do to the outputs, so that a cycle that passes over
  /// many pieces looks at one. Real-time: safe, O(1).
  [[nodiscard]] const OutputEffect& outputs_after(size_t piece) const { return outputs_[piece]; }
  /// Every change of the outputs that are told a time anywhere in the motion: outputs_after() is
  /// not how these change. Real-time: safe.
  [[nodiscard]] const TimedChanges& timed_changes() const { return timed_; }
  /// Pieces that begin with a wait for an input, rising. Real-time: safe.
  [[nodiscard]] const std::vector<size_t>& waits() const { return waits_; }
  [[nodiscard]] const Certificate& certificate() const { return certificate_; }
  /// The planner adds what it alone knows (deviations, manipulability).
  [[nodiscard]] Certificate& certificate() { return certificate_; }
  /// State at t [s], clamped to [0, duration]; at a knot that of the later piece. O(log pieces).
  [[nodiscard]] JointState at(double t) const;
  /// Index of the piece that holds t (the later one at a knot, the last one after the end).
  /// Real-time: safe, O(log pieces).
  [[nodiscard]] size_t piece_at(double t) const;

 private:
  std::vector<TrajectoryPiece> pieces_;
  std::vector<double> starts_;
  std::vector<OutputEffect> outputs_;
  TimedChanges timed_;
  std::vector<size_t> waits_;
  double duration_ = 0.0;
  /// Notes when a piece begins and what it leaves of the outputs.
  void index(const TrajectoryPiece& piece);

  Certificate certificate_;
};

}  // namespace viapoint
