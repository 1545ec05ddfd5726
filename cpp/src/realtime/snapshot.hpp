/// @file
/// The loop's last words, for whoever asks.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/loop_cycle.hpp"

namespace viapoint {

/// The newest cycle. The writer never waits; readers try again when the writer came between (a
/// sequence lock, Boehm 2012).
class Snapshot {
 public:
  explicit Snapshot(int joints) : joints_(joints) {}

  /// One writer. A vector of another size counts as zero. Real-time: safe.
  void write(const LoopCycle& value) noexcept VIAPOINT_NONBLOCKING {
    // Whoever sees one of the values below sees the odd version too: each store releases it.
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);
    cycle_.store(value.cycle, std::memory_order_release);
    stamp_.store(value.stamp, std::memory_order_release);
    state_.store(value.state, std::memory_order_release);
    rate_.store(value.rate, std::memory_order_release);
    override_.store(value.override_share, std::memory_order_release);
    outputs_.store(value.outputs, std::memory_order_release);
    inputs_.store(value.measurement.inputs, std::memory_order_release);
    put(value.q, q_);
    put(value.qd, qd_);
    put(value.qdd, qdd_);
    put(value.measurement.q, measured_);
    version_.store(version + 2, std::memory_order_release);
  }

  /// Any number of readers. Real-time: not.
  [[nodiscard]] LoopCycle read() const {
    LoopCycle value;
    for (JointVector* vector : {&value.q, &value.qd, &value.qdd, &value.measurement.q}) {
      vector->resize(joints_);
    }
    for (;;) {
      const std::uint64_t before = version_.load(std::memory_order_acquire);
      value.cycle = cycle_.load(std::memory_order_acquire);
      value.stamp = stamp_.load(std::memory_order_acquire);
      value.state = state_.load(std::memory_order_acquire);
      value.rate = rate_.load(std::memory_order_acquire);
      value.override_share = override_.load(std::memory_order_acquire);
      value.outputs = outputs_.load(std::memory_order_acquire);
      value.measurement.inputs = inputs_.load(std::memory_order_acquire);
      get(q_, value.q);
      get(qd_, value.qd);
      get(qdd_, value.qdd);
      get(measured_, value.measurement.q);
      if (before % 2 == 0 && version_.load(std::memory_order_relaxed) == before) return value;
    }
  }

 private:
  using Values = std::array<std::atomic<double>, kMaxJoints>;

  void put(const JointVector& from, Values& to) const noexcept VIAPOINT_NONBLOCKING {
    for (int i = 0; i < joints_; ++i) {
      const double value = i < from.size() ? from[i] : 0.0;
      to[static_cast<std::size_t>(i)].store(value, std::memory_order_release);
    }
  }
  void get(const Values& from, JointVector& to) const {
    for (int i = 0; i < joints_; ++i) {
      to[i] = from[static_cast<std::size_t>(i)].load(std::memory_order_acquire);
    }
  }

  int joints_;
  std::atomic<std::uint64_t> version_{0};
  std::atomic<std::uint64_t> cycle_{0}, outputs_{0}, inputs_{0};
  std::atomic<std::int64_t> stamp_{0};
  std::atomic<RunState> state_{RunState::kIdle};
  std::atomic<double> rate_{0.0}, override_{1.0};
  Values q_{}, qd_{}, qdd_{}, measured_{};
};

}  // namespace viapoint
