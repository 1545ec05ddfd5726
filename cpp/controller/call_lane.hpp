/// @file
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace viapoint::controller {

/// A few threads that do calls in the order in which they came, and a queue that ends. Calls of
/// one lane never wait for those of another. Threads: any.
class CallLane {
 public:
  /// @param threads how many calls at once [>= 1]; @param most_waiting calls beyond those
  CallLane(int threads, std::size_t most_waiting);
  /// Does what waits, and ends.
  ~CallLane();
  CallLane(const CallLane&) = delete;
  CallLane& operator=(const CallLane&) = delete;

  /// Has a call done by a thread of the lane; false where too many wait. @pre it throws nothing
  [[nodiscard]] bool take(std::function<void()> call);

 private:
  void work();

  const std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool quits_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace viapoint::controller
