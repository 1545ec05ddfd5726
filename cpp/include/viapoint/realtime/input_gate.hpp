/// @file
/// The inputs that a motion waits for on its way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "viapoint/core/nonblocking.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// Knows where the next wait is, and whether it is over. A wait that is over stays so when the arm
/// goes back and passes it again. Real-time: safe. Threads: one.
class InputGate {
 public:
  /// @param cycle [s], > 0
  explicit InputGate(double cycle) : cycle_(cycle) {}

  /// @pre the trajectory outlives its use here
  void begin(const Trajectory& motion) noexcept VIAPOINT_NONBLOCKING;
  /// Goes on with a motion without the first `dropped` pieces of the one before.
  void lengthen(const Trajectory& motion, std::size_t dropped) noexcept VIAPOINT_NONBLOCKING;
  /// Nominal time at which the arm rests for the next wait [s]; infinity where none comes.
  [[nodiscard]] double place() const noexcept VIAPOINT_NONBLOCKING;
  /// The arm has come there: it waits from now on.
  void arrive() noexcept VIAPOINT_NONBLOCKING;
  /// It goes away, back along its path: the wait begins anew when it comes again.
  void leave() noexcept { waits_ = false; }
  [[nodiscard]] bool waits() const noexcept { return waits_; }
  /// What it waits for, or has waited for in vain. @pre arrive() has been called
  [[nodiscard]] const InputWait& wait() const noexcept { return wait_; }

  enum class Answer : std::uint8_t { kGoOn, kWait, kTimedOut };
  /// One cycle of the wait. @param inputs as measured last, bit by bit
  [[nodiscard]] Answer ask(std::uint64_t inputs) noexcept VIAPOINT_NONBLOCKING;

 private:
  double cycle_;
  const Trajectory* motion_ = nullptr;
  std::size_t next_ = 0;  ///< of the motion's waits
  bool waits_ = false;
  std::uint64_t cycles_ = 0;  ///< of the wait under way
  InputWait wait_;
};

}  // namespace viapoint
