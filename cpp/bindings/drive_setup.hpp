/// @file
/// What Python says of the drive of a loop in its own process, and what it holds of it after.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <variant>

#include "bindings.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/drives/udp_drive.hpp"

namespace viapoint::python {

struct SimulatedSetup {
  JointVector start;
  SimulatedDriveOptions options;
};
using DriveSetup = std::variant<SimulatedSetup, UdpDriveOptions>;

/// Null where the drive has no such thing.
struct DriveLinks {
  std::shared_ptr<std::atomic<std::uint64_t>> inputs;
  std::shared_ptr<GuidingHand> hand;
  std::shared_ptr<UdpTraffic> traffic;
};

/// @throws MotionError(kBadArgument) for a start of another number of joints, and as the drives
[[nodiscard]] std::unique_ptr<Drive> make_drive(const DriveSetup& setup, int joints,
                                                std::chrono::nanoseconds cycle, DriveLinks& links);
/// Datagrams by what became of them.
[[nodiscard]] py::typing::Dict<py::str, py::int_> counts_of(const UdpTraffic& traffic);

/// SimulatedSetup and UdpSetup.
void bind_drives(py::module_& m);

}  // namespace viapoint::python
