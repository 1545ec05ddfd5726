#include "controller/stop_signals.hpp"

#include <ctime>

namespace viapoint::controller {

StopSignals::StopSignals() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
}

StopSignals::~StopSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

bool StopSignals::arrived() {
  const timespec at_once{0, 0};
  return sigtimedwait(&signals_, nullptr, &at_once) > 0;
}

void StopSignals::wait() {
  while (sigwaitinfo(&signals_, nullptr) < 0) {
    // Interrupted by a signal that is not ours.
  }
}

}  // namespace viapoint::controller
