/// @file An interpolator that runs a motion, tick by tick.
#pragma once

#include <chrono>

#include "realtime/random_motion.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {

inline constexpr std::chrono::nanoseconds kCycle{2'000'000};
inline constexpr double kSeconds = 2e-3;

/// What a tick tells, as the log would hold it.
inline LogRecord tick(Interpolator& interpolator) {
  Setpoint setpoint;
  interpolator.tick(setpoint);
  LogRecord record;
  interpolator.describe(setpoint, record);
  record.cycle = setpoint.cycle;
  return record;
}

inline Interpolator start(const Motion& motion) {
  Interpolator interpolator(motion.limits, kCycle, motion.trajectory.at(0.0).q);
  interpolator.begin(motion.trajectory);
  return interpolator;
}

}  // namespace viapoint
