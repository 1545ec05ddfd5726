#include "controller/stop_signals.hpp"

#include <ctime>

namespace viapoint::controller {

StopSignals::StopSignals() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  struct sigaction hang_up{};
  sigaction(SIGHUP, nullptr, &hang_up);
  // What is blocked is no longer ignored.
  if (hang_up.sa_handler != SIG_IGN) sigaddset(&signals_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  // When nobody reads stderr any more, what is said is lost, and not the arm.
  struct sigaction ignore{};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &pipe_before_);
}

StopSignals::~StopSignals() {
  sigaction(SIGPIPE, &pipe_before_, nullptr);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

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
