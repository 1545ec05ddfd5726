#include "viapoint/realtime/motion_log.hpp"

namespace viapoint {

const char* to_string(RunState state) {
  switch (state) {
    case RunState::kIdle:
      return "idle";
    case RunState::kRunning:
      return "running";
    case RunState::kPausing:
      return "pausing";
    case RunState::kPaused:
      return "paused";
    case RunState::kStopping:
      return "stopping";
    case RunState::kStopped:
      return "stopped";
    case RunState::kFinished:
      return "finished";
    case RunState::kFault:
      return "fault";
    case RunState::kJogging:
      return "jogging";
    case RunState::kReturning:
      return "returning";
    case RunState::kWaiting:
      return "waiting";
  }
  return "unknown";
}

}  // namespace viapoint
