/// @file
/// The seam to the hardware. Everything right of the real-time boundary ends here.
#pragma once

#include <cstdint>
#include <string>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint {

/// What the arm is told, once a cycle.
struct Setpoint {
  std::uint64_t cycle = 0;
  JointVector q, qd, qdd, qddd;  ///< (n,) [rad or m, and per s, s², s³]
  std::uint64_t outputs = 0;     ///< digital outputs, bit i is output i
};

/// What the arm tells, once a cycle.
struct Measurement {
  JointVector q;  ///< (n,) [rad or m]
  std::uint64_t inputs = 0;
};

enum class DriveStatus {
  kOk,
  kFault,
  kSilent,     ///< no answer this cycle: nothing was measured
  kPowerLost,  ///< the power went (stop category 0): the arm is where it was measured last
  kGuided,     ///< a hand moves the arm, and setpoints are not followed; the loop follows the hand
};

/// One arm's drives. enable() and release() are called from ordinary threads with the loop at
/// rest; exchange() once a cycle from the real-time thread.
class Drive {
 public:
  virtual ~Drive() = default;
  [[nodiscard]] virtual int joints() const = 0;
  /// Powers up and reports where the arm stands. @throws MotionError(kDriveFault)
  virtual Measurement enable() = 0;
  /// Real-time: must be safe (no heap, no lock, no throw).
  [[nodiscard]] virtual DriveStatus exchange(const Setpoint& setpoint,
                                             Measurement& measurement) noexcept = 0;
  virtual void release() noexcept = 0;
  /// Whether a hand has hold of the arm, or will in the next cycle, as far as the drive knows
  /// before exchange() says kGuided: nothing else is begun then. Threads: any. Real-time: not.
  [[nodiscard]] virtual bool is_held() const noexcept { return false; }
  /// What went wrong, once exchange() has returned kFault or kPowerLost; it is not called again
  /// after that. Real-time: not.
  [[nodiscard]] virtual std::string fault() const { return "the drive reported a fault"; }
};

}  // namespace viapoint
