/// @file
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "viapoint/realtime/drive.hpp"

namespace viapoint {

/// An arm that is where it was told one cycle before. Starts at `start`.
class SimulatedDrive final : public Drive {
 public:
  /// @param inputs what it reports as digital inputs, bit i for input i, written by any thread;
  ///        none: all are off
  explicit SimulatedDrive(const JointVector& start,
                          std::shared_ptr<const std::atomic<std::uint64_t>> inputs = nullptr);
  [[nodiscard]] int joints() const override;
  Measurement enable() override;
  [[nodiscard]] DriveStatus exchange(const Setpoint& setpoint,
                                     Measurement& measurement) noexcept override;
  void release() noexcept override;

 private:
  std::shared_ptr<const std::atomic<std::uint64_t>> inputs_;
  Measurement measurement_;
  JointVector told_;  ///< setpoint of the cycle before
};

}  // namespace viapoint
