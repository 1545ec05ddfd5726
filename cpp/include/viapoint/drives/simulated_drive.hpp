/// @file
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <random>

#include "viapoint/drives/guiding_hand.hpp"
#include "viapoint/realtime/drive.hpp"

namespace viapoint {

/// How a simulated arm follows, and how its encoders read. As it stands: exactly.
struct SimulatedDriveOptions {
  double lag = 0.0;         ///< time constant of each joint, a first-order lag [s]
  double resolution = 0.0;  ///< step of the encoders [rad or m]; 0: none
  double noise = 0.0;       ///< standard deviation of a reading [rad or m]
  std::uint64_t seed = 0;   ///< of the noise
  std::chrono::nanoseconds cycle{2'000'000};  ///< of the loop
};

/// An arm that is where it was told one cycle before, or on its way there with a lag. It holds each
/// setpoint for a cycle h, so with the time constant T, x(k+1) = u(k) + e^(-h/T) (x(k) - u(k)).
class SimulatedDrive final : public Drive {
 public:
  /// @param start where the arm stands, (n,)
  /// @param inputs what it reports as digital inputs, bit i for input i, written by any thread;
  ///        none: all are off
  /// @param hand that may guide the arm: it is reported where the hand holds it, as it is, without
  ///        lag or noise (DriveStatus::kGuided); none: nobody does
  /// @throws MotionError(kBadArgument) for options that are negative or not finite
  explicit SimulatedDrive(const JointVector& start,
                          std::shared_ptr<const std::atomic<std::uint64_t>> inputs = nullptr,
                          const SimulatedDriveOptions& options = {},
                          std::shared_ptr<GuidingHand> hand = nullptr);
  [[nodiscard]] int joints() const override;
  /// Where the arm stands, without noise: a drive at rest has time to read its encoders often.
  Measurement enable() override;
  [[nodiscard]] DriveStatus exchange(const Setpoint& setpoint,
                                     Measurement& measurement) noexcept override;
  void release() noexcept override;
  [[nodiscard]] bool is_held() const noexcept override {
    return hand_ != nullptr && hand_->guides();
  }

 private:
  /// What the encoders read of the position.
  void read_encoders() noexcept;

  std::shared_ptr<const std::atomic<std::uint64_t>> inputs_;
  std::shared_ptr<GuidingHand> hand_;
  double kept_;  ///< share of the following error that is left after a cycle
  double resolution_, noise_;
  std::mt19937_64 random_;
  std::normal_distribution<double> unit_normal_;
  JointVector position_;
  JointVector told_;  ///< setpoint of the cycle before
  Measurement measurement_;
};

}  // namespace viapoint
