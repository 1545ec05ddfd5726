/// @file
#pragma once

#include <csignal>

namespace viapoint::controller {

/// While it lives, SIGINT and SIGTERM wait to be asked for instead of ending the process. Made
/// before any other thread, so that all of them inherit it.
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
};

}  // namespace viapoint::controller
