/// @file
#pragma once

#include <cstdint>

#include "viapoint/core/joint_vector.hpp"
#include "viapoint/realtime/drive.hpp"
#include "viapoint/realtime/motion_log.hpp"

namespace viapoint {

/// What the loop decided in one cycle, and what the drive answered: for whoever looks on.
struct LoopCycle {
  std::uint64_t cycle = 0;           ///< since the loop began; after a fault it stays
  std::int64_t stamp = 0;            ///< clock at wake-up [ns]
  RunState state = RunState::kIdle;  ///< kFault once the loop has failed
  double rate = 0.0;                 ///< dτ/dt, negative backward
  double override_share = 1.0;
  JointVector q, qd, qdd;     ///< setpoint [rad or m, and per s, s²]
  std::uint64_t outputs = 0;  ///< digital outputs as sent, bit i is output i
  Measurement measurement;
};

/// What was measured in one cycle.
struct ObservedCycle {
  std::uint64_t cycle = 0;                ///< since the loop began, from 1
  std::int64_t stamp = 0;                 ///< clock at wake-up [ns]
  JointVector q;                          ///< measured, (n,) [rad or m]
  std::uint64_t inputs = 0, outputs = 0;  ///< bit i is input or output i
};

}  // namespace viapoint
