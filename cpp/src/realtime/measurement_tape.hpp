/// @file
/// What was measured in the last cycles, for whoever records.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/loop_cycle.hpp"

namespace viapoint {

/// The last cycles, by their numbers. The writer never waits; a reader leaves out what the writer
/// has written over meanwhile (a sequence lock a cycle, Boehm 2012).
class MeasurementTape {
 public:
  /// Eight seconds at 500 Hz for a reader to come round.
  static constexpr std::uint64_t kCycles = 4096;

  explicit MeasurementTape(int joints)
      : joints_(static_cast<std::size_t>(joints)),
        slots_(std::make_unique<Slot[]>(kCycles)),
        q_(std::make_unique<std::atomic<double>[]>(kCycles * joints_)) {}

  /// One writer, whose cycles count up by one from 1. A vector of another size counts as zero.
  /// Real-time: safe.
  void write(const LoopCycle& value) noexcept VIAPOINT_NONBLOCKING {
    // Whoever sees one of the values below sees that the slot is none's: each store releases it.
    const std::uint64_t place = value.cycle % kCycles;
    Slot& slot = slots_[place];
    slot.cycle.store(0, std::memory_order_relaxed);
    slot.stamp.store(value.stamp, std::memory_order_release);
    slot.inputs.store(value.measurement.inputs, std::memory_order_release);
    slot.outputs.store(value.outputs, std::memory_order_release);
    const auto& q = value.measurement.q;
    for (std::size_t i = 0; i < joints_; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      q_[place * joints_ + i].store(joint < q.size() ? q[joint] : 0.0, std::memory_order_release);
    }
    slot.cycle.store(value.cycle, std::memory_order_release);
    newest_.store(value.cycle, std::memory_order_release);
  }

  /// The cycles from number `from` on that are still there, `most` of them at most, in order.
  /// Real-time: not. Threads: any.
  [[nodiscard]] std::vector<ObservedCycle> read(std::uint64_t from, std::size_t most) const {
    const std::uint64_t newest = newest_.load(std::memory_order_acquire);
    const std::uint64_t oldest = newest > kCycles ? newest - kCycles + 1 : 1;
    std::vector<ObservedCycle> found;
    ObservedCycle one;
    one.q.resize(static_cast<Eigen::Index>(joints_));
    for (one.cycle = std::max(from, oldest); one.cycle <= newest && found.size() < most;
         ++one.cycle) {
      if (get(one)) found.push_back(one);
    }
    return found;
  }

 private:
  struct Slot {
    std::atomic<std::uint64_t> cycle{0}, inputs{0}, outputs{0};
    std::atomic<std::int64_t> stamp{0};
  };

  /// False where `one.cycle` has been written over.
  [[nodiscard]] bool get(ObservedCycle& one) const {
    const std::uint64_t place = one.cycle % kCycles;
    const Slot& slot = slots_[place];
    if (slot.cycle.load(std::memory_order_acquire) != one.cycle) return false;
    one.stamp = slot.stamp.load(std::memory_order_acquire);
    one.inputs = slot.inputs.load(std::memory_order_acquire);
    one.outputs = slot.outputs.load(std::memory_order_acquire);
    for (std::size_t i = 0; i < joints_; ++i) {
      one.q[static_cast<Eigen::Index>(i)] = q_[place * joints_ + i].load(std::memory_order_acquire);
    }
    return slot.cycle.load(std::memory_order_relaxed) == one.cycle;
  }

  std::size_t joints_;
  std::atomic<std::uint64_t> newest_{0};
  std::unique_ptr<Slot[]> slots_;
  std::unique_ptr<std::atomic<double>[]> q_;
};

}  // namespace viapoint
