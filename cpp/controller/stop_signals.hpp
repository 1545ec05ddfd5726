/// @file
#pragma once

#include <csignal>

namespace viapoint::controller {

/// While it lives, nothing from outside but SIGKILL ends the process in the midst of a motion:
/// SIGINT, SIGTERM and SIGHUP (unless it is ignored, as under nohup) wait to be asked for, and
/// SIGPIPE is ignored. Made before any other thread, so that all of them inherit it.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// True when one has come since the last call.
  [[nodiscard]] bool arrived();
  /// Waits for one.
  void wait();

 private:
  sigset_t signals_{}, before_{};
  struct sigaction pipe_before_{};
};

}  // namespace viapoint::controller
