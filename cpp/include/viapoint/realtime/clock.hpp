/// @file
#pragma once

#include <chrono>
#include <cstdint>

namespace viapoint {

/// Time for the loop: the machine's, or a virtual one that never waits.
class Clock {
 public:
  virtual ~Clock() = default;
  /// [ns] since some fixed moment. Real-time: safe.
  [[nodiscard]] virtual std::int64_t now() const noexcept = 0;
  /// Sleeps until `instant` [ns]. Real-time: safe (the cycle's one system call).
  virtual void sleep_until(std::int64_t instant) noexcept = 0;
  /// True where time passes by sleeping only: a loop on such a clock may wait for its companion
  /// without being late, and needs no real-time rights.
  [[nodiscard]] virtual bool is_virtual() const noexcept { return false; }
};

/// CLOCK_MONOTONIC with absolute clock_nanosleep.
class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t now() const noexcept override;
  void sleep_until(std::int64_t instant) noexcept override;
};

/// Jumps at once to the instant slept for: deterministic runs at the speed of the processor.
class VirtualClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t now() const noexcept override { return now_; }
  void sleep_until(std::int64_t instant) noexcept override {
    if (instant > now_) now_ = instant;
  }
  [[nodiscard]] bool is_virtual() const noexcept override { return true; }

 private:
  std::int64_t now_ = 0;
};

}  // namespace viapoint
