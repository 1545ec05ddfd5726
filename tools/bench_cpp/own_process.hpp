/// @file
/// Measuring in a process of its own, whose memory begins small.
#pragma once

#include <functional>

namespace viapoint::bench {

/// What this process has needed at most so far [bytes].
[[nodiscard]] double peak_memory();
/// Runs `measure` in a process of its own. @throws std::runtime_error where it fails there
void apart(const std::function<void()>& measure);

}  // namespace viapoint::bench
