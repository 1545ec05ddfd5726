/// @file
#pragma once

#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/remote/arm_host.hpp"

namespace viapoint {

/// What the loop alone knows.
[[nodiscard]] inline HostStatus look_at(const ControllerLoop& loop) {
  HostStatus status;
  status.setpoint = loop.position();
  const LoopCycle now = loop.newest_cycle();
  status.measured = now.measurement.q;
  status.stamp = now.stamp;
  status.cycle = now.cycle;
  status.inputs = now.measurement.inputs;
  status.outputs = now.outputs;
  status.override_share = loop.override_share();
  status.busy = loop.busy();
  status.jogging = loop.jogging();
  status.guided = loop.guided();
  status.jog_block = loop.jog_block();
  status.fault = loop.fault();
  status.shortcomings = loop.shortcomings();
  return status;
}

}  // namespace viapoint
