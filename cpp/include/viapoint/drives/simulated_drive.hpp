/// @file
#pragma once

#include <memory>

#include "viapoint/realtime/drive.hpp"

namespace viapoint {

/// An arm that is where it was told one cycle before. Starts at `start`. No inputs.
class SimulatedDrive final : public Drive {
 public:
  explicit SimulatedDrive(const JointVector& start);
  [[nodiscard]] int joints() const override;
  Measurement enable() override;
  [[nodiscard]] DriveStatus exchange(const Setpoint& setpoint,
                                     Measurement& measurement) noexcept override;
  void release() noexcept override;

 private:
  Measurement measurement_;
  JointVector told_;  ///< setpoint of the cycle before
};

}  // namespace viapoint
