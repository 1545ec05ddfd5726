/// @file
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint {

enum class RunState : std::uint8_t {
  kIdle,
  kRunning,
  kPausing,
  kPaused,
  kStopping,
  kStopped,  ///< came to rest on the path before its end
  kFinished,
  kFault,
  kJogging,    ///< follows wished velocities, or comes to rest after them
  kReturning,  ///< on its way back to where a jog left the path
  kWaiting,    ///< at rest for an input, or where the motion ends for now: more has not come yet
};

[[nodiscard]] const char* to_string(RunState state);

/// One cycle as it was executed: fixed size, goes through a lock-free ring to an ordinary thread.
struct LogRecord {
  std::uint64_t cycle = 0;    ///< from the start of the run
  std::int64_t stamp = 0;     ///< clock at wake-up [ns], CLOCK_MONOTONIC on the machine's clock
  std::int64_t latency = 0;   ///< wake-up after its due instant [ns]
  std::int64_t compute = 0;   ///< the tick's own computing time [ns]
  double nominal_time = 0.0;  ///< τ along the motion [s]
  double rate = 0.0;          ///< dτ/dt, negative backward
  std::int32_t move = -1;     ///< program step under way
  RunState state = RunState::kIdle;
  std::uint64_t outputs = 0;
  JointVector q, qd, qdd, qddd;  ///< setpoint (derivatives by real time, not nominal time)
  JointVector measured;          ///< what the drive reported
};

}  // namespace viapoint
