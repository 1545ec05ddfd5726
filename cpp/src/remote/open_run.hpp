/// @file
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/remote/hand_over.hpp"

namespace viapoint {

/// A run that gets longer: an OpenJob, for callers in any thread.
class OpenRun {
 public:
  explicit OpenRun(std::shared_ptr<OpenJob> job) : job_(std::move(job)) {}

  /// As OpenJob::lengthen; it takes as long as the proof does.
  void lengthen(std::shared_ptr<const Trajectory> next, double leave) {
    const std::lock_guard lock(mutex_);
    job_->lengthen(std::move(next), leave);
  }
  /// As OpenJob::close.
  void close() {
    const std::lock_guard lock(mutex_);
    job_->close();
  }
  [[nodiscard]] HandOver look() {
    const std::lock_guard lock(mutex_);
    return {job_->fate(), job_->earliest_leave(), job_->waited_cycles()};
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<OpenJob> job_;
};

}  // namespace viapoint
