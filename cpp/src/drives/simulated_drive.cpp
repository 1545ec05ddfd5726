#include "viapoint/drives/simulated_drive.hpp"

namespace viapoint {

SimulatedDrive::SimulatedDrive(const JointVector& start) : measurement_{start, 0}, told_(start) {}

int SimulatedDrive::joints() const { return static_cast<int>(measurement_.q.size()); }

Measurement SimulatedDrive::enable() { return measurement_; }

DriveStatus SimulatedDrive::exchange(const Setpoint& setpoint, Measurement& measurement) noexcept {
  measurement_.q = told_;
  told_ = setpoint.q;
  measurement = measurement_;
  return DriveStatus::kOk;
}

void SimulatedDrive::release() noexcept {}

}  // namespace viapoint
