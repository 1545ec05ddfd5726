/// @file
/// What the operating system must grant for a cycle that is never late.
#pragma once

#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace viapoint {

/// Keeps all memory of the process resident while any copy lives; null where that is not granted.
using MemoryLock = std::shared_ptr<void>;

/// Locks the memory of the process, or says in one line of `shortcomings` what stands against it.
[[nodiscard]] MemoryLock lock_memory(std::vector<std::string>& shortcomings);

/// Runs `thread` under SCHED_FIFO at `priority`, or says in one line what stands against it.
void raise_priority(std::thread& thread, int priority, std::vector<std::string>& shortcomings);

/// For a thread's own use at its start: signals go to other threads, and sleeps end on time even
/// without real-time priority.
void prepare_loop_thread();
void block_signals();

}  // namespace viapoint
