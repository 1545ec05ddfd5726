#include "realtime/realtime_rights.hpp"

#include <fcntl.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <mutex>

namespace viapoint {
namespace {

bool has_capability(int capability) {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> data{};
  if (syscall(SYS_capget, &header, data.data()) != 0) return false;
  const auto word = static_cast<std::size_t>(capability / 32);
  return (data[word].effective >> (capability % 32) & 1U) != 0;
}

/// Under a finite RLIMIT_MEMLOCK, MCL_FUTURE would make later allocations of the process fail.
bool may_lock_everything() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  return has_capability(CAP_IPC_LOCK);
}

/// Has the kernel give the thread its stack now, and not in the middle of a cycle.
void touch_stack() {
  constexpr std::size_t kPage = 4096, kStack = 16 * kPage;
  std::array<volatile char, kStack> stack;
  for (std::size_t i = 0; i < kStack; i += kPage) stack[i] = 0;
}

}  // namespace

MemoryLock lock_memory(std::vector<std::string>& shortcomings) {
  static std::mutex mutex;
  static std::weak_ptr<void> shared;
  const std::lock_guard lock(mutex);
  if (MemoryLock held = shared.lock()) return held;
  std::string reason;
  if (!may_lock_everything()) {
    reason = "RLIMIT_MEMLOCK is finite";
  } else if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    reason = std::strerror(errno);
  } else {
    static int locked = 0;
    const MemoryLock held(&locked, [](void*) { munlockall(); });
    shared = held;
    return held;
  }
  shortcomings.push_back("memory is not locked, a page fault may delay a cycle (mlockall: " +
                         reason + "); allow it with \"ulimit -l unlimited\" or CAP_IPC_LOCK");
  return nullptr;
}

void raise_priority(std::thread& thread, int priority, std::vector<std::string>& shortcomings) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(thread.native_handle(), SCHED_FIFO, &parameters);
  if (error == 0) return;
  shortcomings.push_back("the loop runs without real-time priority, other programs may delay a " +
                         std::string("cycle (SCHED_FIFO ") + std::to_string(priority) + ": " +
                         std::strerror(error) + "); allow it with \"ulimit -r " +
                         std::to_string(priority) + "\" or CAP_SYS_NICE");
}

void keep_on(std::thread& thread, int processor, std::vector<std::string>& shortcomings) {
  cpu_set_t only;
  CPU_ZERO(&only);
  int error = EINVAL;
  if (processor >= 0 && processor < CPU_SETSIZE) {
    CPU_SET(static_cast<std::size_t>(processor), &only);
    error = pthread_setaffinity_np(thread.native_handle(), sizeof only, &only);
  }
  if (error == 0) return;
  shortcomings.push_back("the loop is not kept on processor " + std::to_string(processor) + " (" +
                         std::strerror(error) + "); allow it with one that there is, 0 to " +
                         std::to_string(sysconf(_SC_NPROCESSORS_CONF) - 1) +
                         ", and that the process is not kept from");
}

WakefulProcessors keep_processors_awake(std::vector<std::string>& shortcomings) {
  constexpr std::int32_t kLatency = 0;  // [µs]
  const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  if (file >= 0 && write(file, &kLatency, sizeof kLatency) == sizeof kLatency) {
    static int held = 0;
    return {&held, [file](void*) { close(file); }};
  }
  const std::string reason = std::strerror(errno);
  if (file >= 0) close(file);
  shortcomings.push_back(
      "processors may sleep deeply between cycles and wake up late (/dev/cpu_dma_latency: " +
      reason + "); allow it with a udev rule that lets this account write the file");
  return nullptr;
}

void block_signals() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

void prepare_loop_thread() {
  block_signals();
  // Without real-time priority the kernel may round a sleep up by 50 µs.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  touch_stack();
}

}  // namespace viapoint
