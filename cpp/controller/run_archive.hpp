/// @file
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint::controller {

/// Writes the log of every run into a folder when the run has ended, from a thread of its own: a
/// file a run, named after the time and the run's number. A disk that is full or gone is said in
/// the process's log and disturbs nothing else. Threads: any.
class RunArchive {
 public:
  /// @throws MotionError(kFile) for a folder that cannot be written into
  explicit RunArchive(const std::string& folder);
  /// Writes what has ended by then.
  ~RunArchive();
  RunArchive(const RunArchive&) = delete;
  RunArchive& operator=(const RunArchive&) = delete;

  /// Takes a run that has begun, after those before it. Of more than kMostWaiting that wait for a
  /// slow disk the oldest is dropped, which is said.
  void add(std::uint64_t number, std::shared_ptr<Job> job);
  static constexpr std::size_t kMostWaiting = 1000;

 private:
  struct Run {
    std::uint64_t number = 0;
    std::shared_ptr<Job> job;
  };

  void follow(const std::stop_token& stop);
  /// The oldest that waits, if there is one.
  [[nodiscard]] Run first();
  /// True once there is nothing left to write of it.
  [[nodiscard]] bool archive(const Run& run) const;

  std::string folder_;
  std::mutex mutex_;  ///< guards what follows
  std::deque<Run> waiting_;
  std::jthread thread_;
};

}  // namespace viapoint::controller
