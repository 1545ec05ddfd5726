/// @file
/// Outputs that change at a time before or after the arm passes a place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/rate_governor.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// Switches each change in the first cycle in which it is due, and never before the changes of the
/// same output that come before it:
///   - after the place, when the arm was there at that time of the clock, whatever it does since;
///   - before the place, when at the rate decided so far it will be there in that time. A rate that
///     falls afterwards makes the change early; one that rises makes it late, by no more than the
///     place itself.
/// None is switched twice: a place that is passed again, after going back, is passed already.
///
/// For each output only the next change is looked at, so a cycle costs O(outputs that are told
/// times), but for those passed in one cycle. Real-time: all but the constructor is safe. Threads:
/// one.
class TimedOutputs {
 public:
  /// @param cycle [s], > 0. Allocates.
  explicit TimedOutputs(double cycle);

  /// Where the arm is in its motion, and what is known of where it gets to [s, nominal].
  struct Progress {
    double farthest = 0.0;  ///< so far
    double until = 0.0;     ///< it rests here, whatever the rate: no foresight beyond
    bool is_ahead = false;  ///< it goes on into what is new: `now` counts
    RateState now;
  };

  /// @param outputs as they are, bit by bit
  void begin(const TimedChanges& changes, std::uint64_t outputs) noexcept VIAPOINT_NONBLOCKING;
  /// Goes on with a motion without the first `dropped` pieces, `shift` [s], of the one before.
  /// @param farthest in the motion before [s]
  void lengthen(const TimedChanges& changes, std::size_t dropped, double shift, double farthest,
                std::uint64_t outputs) noexcept VIAPOINT_NONBLOCKING;
  /// One cycle. @returns the outputs that are told times, as they are now
  std::uint64_t tick(const Progress& progress,
                     const RateGovernor& governor) noexcept VIAPOINT_NONBLOCKING;
  /// The motion has ended: what is still due comes now. @returns as tick()
  std::uint64_t end() noexcept VIAPOINT_NONBLOCKING;
  /// Outputs that are told times, bit by bit.
  [[nodiscard]] std::uint64_t mask() const noexcept {
    return changes_ == nullptr ? 0 : changes_->outputs();
  }

 private:
  [[nodiscard]] bool is_due(const TimedChange& change, const Progress& progress,
                            const RateGovernor& governor) const noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] double farthest_before(double time) const noexcept VIAPOINT_NONBLOCKING;
  void set(int output, bool value) noexcept VIAPOINT_NONBLOCKING;

  double cycle_;
  const TimedChanges* changes_ = nullptr;
  std::array<std::size_t, kDigitalOutputs> next_{};  ///< change of each output
  std::uint64_t outputs_ = 0;
  double left_out_ = 0.0;         ///< nominal time of what was left out at the beginning [s]
  std::vector<double> farthest_;  ///< in the last cycles, a ring [s since the run began]
  std::size_t cycles_ = 0;        ///< of the run
};

}  // namespace viapoint
