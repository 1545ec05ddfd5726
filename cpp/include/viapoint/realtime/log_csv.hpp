/// @file
/// The log of a run as a table that reads back to the last bit.
#pragma once

#include <span>
#include <string>

#include "viapoint/realtime/motion_log.hpp"

namespace viapoint {

/// One row a cycle: cycle, stamp_ns, latency_ns, compute_ns, nominal_time, rate, move, state,
/// outputs, then q1..qn, qd1.., qdd1.., qddd1.., measured1.. (empty where nothing was measured).
/// Numbers are the shortest text that reads back to the same bits. Real-time: not.
[[nodiscard]] std::string log_to_csv(std::span<const LogRecord> records);
/// The same into a file, whole or not at all, and in pieces: it takes no memory to speak of.
/// Real-time: not. @throws MotionError(kFile)
void write_log_csv(const std::string& path, std::span<const LogRecord> records);

}  // namespace viapoint
