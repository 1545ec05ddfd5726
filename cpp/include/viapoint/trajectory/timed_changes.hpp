/// @file
/// Changes of outputs by the clock, in an order that the tick can follow.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// A change of one output.
struct TimedChange {
  double place = 0.0;     ///< nominal time at which the arm passes the place it hangs on [s]
  double time = 0.0;      ///< on the clock, after that (OutputChange::time) [s]
  std::size_t piece = 0;  ///< that begins there
  bool value = false;
};

/// The changes of every output that is told a time somewhere in a motion, output by output, each in
/// the order of the places. An output of which one change has a time has all of them here: only so
/// one of them can wait for the one before it.
/// Immutable once built. Threads: any.
class TimedChanges {
 public:
  TimedChanges() = default;
  /// @param starts when each piece begins, nominal [s]
  /// @param also outputs that belong here whatever the pieces tell, bit by bit
  TimedChanges(std::span<const TrajectoryPiece> pieces, std::span<const double> starts,
               std::uint64_t also = 0);

  /// Outputs that have their changes here, bit i for output i. Real-time: safe.
  [[nodiscard]] std::uint64_t outputs() const { return outputs_; }
  /// Of one output; none where it is not among outputs(). Real-time: safe.
  [[nodiscard]] std::span<const TimedChange> of(int output) const {
    const auto at = static_cast<std::size_t>(output);
    return std::span(changes_).subspan(begins_[at], begins_[at + 1] - begins_[at]);
  }

 private:
  std::uint64_t outputs_ = 0;
  std::vector<TimedChange> changes_;
  std::array<std::size_t, kDigitalOutputs + 1> begins_{};
};

}  // namespace viapoint
