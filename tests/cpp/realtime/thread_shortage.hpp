/// @file
#pragma once

namespace viapoint {

/// While it lives, the operating system refuses to create a thread: `allowed` more begin, then
/// pthread_create says EAGAIN. For the thread that made it only.
class ThreadShortage {
 public:
  explicit ThreadShortage(int allowed);
  ~ThreadShortage();
  ThreadShortage(const ThreadShortage&) = delete;
  ThreadShortage& operator=(const ThreadShortage&) = delete;
};

}  // namespace viapoint
