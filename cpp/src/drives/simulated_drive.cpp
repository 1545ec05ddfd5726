#include "viapoint/drives/simulated_drive.hpp"

#include <utility>

namespace viapoint {

SimulatedDrive::SimulatedDrive(const JointVector& start,
                               std::shared_ptr<const std::atomic<std::uint64_t>> inputs)
    : inputs_(std::move(inputs)), measurement_{start, 0}, told_(start) {}

int SimulatedDrive::joints() const { return static_cast<int>(measurement_.q.size()); }

Measurement SimulatedDrive::enable() { return measurement_; }

DriveStatus SimulatedDrive::exchange(const Setpoint& setpoint, Measurement& measurement) noexcept {
  measurement_.q = told_;
  if (inputs_ != nullptr) measurement_.inputs = inputs_->load(std::memory_order_acquire);
  told_ = setpoint.q;
  measurement = measurement_;
  return DriveStatus::kOk;
}

void SimulatedDrive::release() noexcept {}

}  // namespace viapoint
