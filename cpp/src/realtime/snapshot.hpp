/// @file
/// The loop's last words, for whoever asks.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/drive.hpp"

namespace viapoint {

/// Setpoint and measurement of one cycle. The writer never waits; readers try again when the
/// writer came between (a sequence lock, Boehm 2012).
class Snapshot {
 public:
  struct Value {
    JointVector position;
    Measurement measurement;
  };

  explicit Snapshot(int joints) : joints_(joints) {}

  /// One writer. Real-time: safe.
  void write(const JointVector& position,
             const Measurement& measurement) noexcept VIAPOINT_NONBLOCKING {
    // Whoever sees one of the values below sees the odd version too: each store releases it.
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);
    for (int i = 0; i < joints_; ++i) {
      const auto at = static_cast<std::size_t>(i);
      position_[at].store(position[i], std::memory_order_release);
      measured_[at].store(i < measurement.q.size() ? measurement.q[i] : 0.0,
                          std::memory_order_release);
    }
    inputs_.store(measurement.inputs, std::memory_order_release);
    version_.store(version + 2, std::memory_order_release);
  }

  /// Any number of readers. Real-time: not.
  [[nodiscard]] Value read() const {
    Value value{JointVector(joints_), {JointVector(joints_), 0}};
    for (;;) {
      const std::uint64_t before = version_.load(std::memory_order_acquire);
      for (int i = 0; i < joints_; ++i) {
        const auto at = static_cast<std::size_t>(i);
        value.position[i] = position_[at].load(std::memory_order_acquire);
        value.measurement.q[i] = measured_[at].load(std::memory_order_acquire);
      }
      value.measurement.inputs = inputs_.load(std::memory_order_acquire);
      if (before % 2 == 0 && version_.load(std::memory_order_relaxed) == before) return value;
    }
  }

 private:
  using Values = std::array<std::atomic<double>, kMaxJoints>;
  int joints_;
  std::atomic<std::uint64_t> version_{0};
  Values position_{}, measured_{};
  std::atomic<std::uint64_t> inputs_{0};
};

}  // namespace viapoint
