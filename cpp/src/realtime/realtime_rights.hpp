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

/// Keeps `thread` on one processor, counted from 0, or says in one line what stands against it.
void keep_on(std::thread& thread, int processor, std::vector<std::string>& shortcomings);

/// Keeps the machine's processors out of sleeps that they wake from late while any copy lives; null
/// where that is not granted.
using WakefulProcessors = std::shared_ptr<void>;

/// Asks for it (Linux, pm_qos_interface: /dev/cpu_dma_latency at 0 µs while it is open), or says in
/// one line of `shortcomings` what stands against it.
[[nodiscard]] WakefulProcessors keep_processors_awake(std::vector<std::string>& shortcomings);

/// For a thread's own use at its start: signals go to other threads, sleeps end on time even
/// without real-time priority, and the stack that a cycle needs is there even where memory cannot
/// be locked.
void prepare_loop_thread();
void block_signals();

}  // namespace viapoint
