/// @file
/// Wished velocities on their way into the tick.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "viapoint/core/joint_vector.hpp"
#include "viapoint/core/nonblocking.hpp"

namespace viapoint {

/// The last wish, and whether the tick has seen it. A sequence lock (Boehm 2012) the other way
/// round than Snapshot: the reader is the tick, which never tries twice; a wish that is being
/// written is read one cycle later.
class JogChannel {
 public:
  /// One writer at a time. Real-time: not.
  void write(const JointVector& velocity) {
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);
    for (int i = 0; i < velocity.size(); ++i) {
      velocity_[static_cast<std::size_t>(i)].store(velocity[i], std::memory_order_release);
    }
    version_.store(version + 2, std::memory_order_release);
  }

  /// True where there is a wish that was not read yet; it is then in `velocity`, whose size says
  /// how many joints there are. Real-time: safe.
  [[nodiscard]] bool read(JointVector& velocity) noexcept VIAPOINT_NONBLOCKING {
    const std::uint64_t before = version_.load(std::memory_order_acquire);
    if (before % 2 != 0 || before == read_.load(std::memory_order_relaxed)) return false;
    for (int i = 0; i < velocity.size(); ++i) {
      velocity[i] = velocity_[static_cast<std::size_t>(i)].load(std::memory_order_acquire);
    }
    if (version_.load(std::memory_order_relaxed) != before) return false;
    taken_ = before;
    return true;
  }
  /// The tick has acted on what it read. Real-time: safe.
  void done() noexcept VIAPOINT_NONBLOCKING { read_.store(taken_, std::memory_order_release); }

  /// True until the tick has acted on the last wish.
  [[nodiscard]] bool pending() const {
    return read_.load(std::memory_order_acquire) != version_.load(std::memory_order_relaxed);
  }

 private:
  std::array<std::atomic<double>, kMaxJoints> velocity_{};
  std::atomic<std::uint64_t> version_{0}, read_{0};
  std::uint64_t taken_ = 0;  ///< the tick's own
};

}  // namespace viapoint
