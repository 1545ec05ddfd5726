/// @file
/// Digital outputs that somebody switches by hand while a motion switches them, too.
#pragma once

#include <atomic>
#include <cstdint>

#include "viapoint/core/nonblocking.hpp"

namespace viapoint {

/// What ordinary threads want switched. Nobody waits. Threads: any number that switch, one that
/// takes.
class OutputSwitches {
 public:
  /// Of two calls at once either may come last. @param mask which outputs; @param values on or off
  void set(std::uint64_t mask, std::uint64_t values) {
    const std::uint64_t on = mask & values, off = mask & ~values;
    // What is wanted now is no longer wanted otherwise; that goes first, so that a bit which the
    // tick finds in both is newer in off_ (take() reads that one last).
    off_.fetch_and(~on, std::memory_order_acq_rel);
    on_.fetch_and(~off, std::memory_order_acq_rel);
    on_.fetch_or(on, std::memory_order_acq_rel);
    off_.fetch_or(off, std::memory_order_acq_rel);
  }

  /// Switches of `outputs` what was wanted since the last call. Real-time: safe.
  [[nodiscard]] std::uint64_t take(std::uint64_t outputs) noexcept VIAPOINT_NONBLOCKING {
    if (on_.load(std::memory_order_relaxed) != 0) {
      outputs |= on_.exchange(0, std::memory_order_acq_rel);
    }
    if (off_.load(std::memory_order_relaxed) != 0) {
      outputs &= ~off_.exchange(0, std::memory_order_acq_rel);
    }
    return outputs;
  }

 private:
  std::atomic<std::uint64_t> on_{0}, off_{0};
};

/// The outputs as they are sent: each as whoever changed it last left it, the motion or a hand.
/// Real-time: safe. Threads: one.
class OutputPanel {
 public:
  /// The motion's outputs, once a cycle: what it has changed since the last time is switched.
  void follow(std::uint64_t motion) noexcept VIAPOINT_NONBLOCKING {
    const std::uint64_t changed = motion ^ motion_;
    motion_ = motion;
    sent_ = (sent_ & ~changed) | (motion & changed);
  }
  void switch_by_hand(OutputSwitches& hand) noexcept VIAPOINT_NONBLOCKING {
    sent_ = hand.take(sent_);
  }
  /// A motion that begins takes the outputs as they are.
  void hand_over() noexcept VIAPOINT_NONBLOCKING { motion_ = sent_; }
  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }

 private:
  std::uint64_t motion_ = 0, sent_ = 0;
};

}  // namespace viapoint
