/// @file
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/remote/hand_over.hpp"

namespace viapoint {

/// A run that gets longer: its Follower, for callers in any thread.
class OpenRun {
 public:
  explicit OpenRun(std::shared_ptr<Follower> run) : run_(std::move(run)) {}

  /// As Follower::lengthen; it takes as long as the proof does.
  void lengthen(std::shared_ptr<const Trajectory> next, double leave) {
    const std::lock_guard lock(mutex_);
    run_->lengthen(std::move(next), leave);
  }
  /// As Follower::close.
  void close() {
    const std::lock_guard lock(mutex_);
    run_->close();
  }
  [[nodiscard]] HandOver look() {
    const std::lock_guard lock(mutex_);
    return {run_->fate(), run_->earliest_leave(), run_->waited_cycles()};
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<Follower> run_;
};

}  // namespace viapoint
