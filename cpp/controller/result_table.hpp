/// @file
#pragma once

#include <string>

#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint::controller {

/// The figures of a run for people: times, cycles, latency, and the proven shares of the limits.
[[nodiscard]] std::string result_table(const Trajectory& trajectory, const Job& job);

}  // namespace viapoint::controller
