/// @file
/// The motion between the setpoints, rebuilt from the setpoints themselves.
#pragma once

#include <span>

#include "realtime/random_motion.hpp"
#include "viapoint/realtime/motion_log.hpp"

namespace viapoint {

/// Largest shares of a run, between its cycles too.
struct Shares {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
  std::size_t cycle = 0;  ///< where the largest of them is

  [[nodiscard]] double worst() const;
};

/// Runs over every cycle of `log` with `samples` points in each. Within a cycle the rate is a
/// parabola: nominal time and rate at both ends determine it, so nothing is taken from the
/// interpolator but what it logged.
[[nodiscard]] Shares worst_shares(const Motion& motion, std::span<const LogRecord> log,
                                  double cycle, int samples);

}  // namespace viapoint
