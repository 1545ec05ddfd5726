#include "viapoint/drives/simulated_drive.hpp"

#include <cmath>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"

namespace viapoint {
namespace {

double at_least_zero(double value, const char* name) {
  if (std::isfinite(value) && value >= 0.0) return value;
  throw MotionError(ErrorCode::kBadArgument, std::string("the simulated drive's ") + name + " is " +
                                                 number_text(value) +
                                                 "; it must be a finite number from 0 on");
}

double share_kept(const SimulatedDriveOptions& options) {
  const double lag = at_least_zero(options.lag, "lag");
  const double cycle = std::chrono::duration<double>(options.cycle).count();
  return lag > 0.0 ? std::exp(-cycle / lag) : 0.0;
}

}  // namespace

SimulatedDrive::SimulatedDrive(const JointVector& start,
                               std::shared_ptr<const std::atomic<std::uint64_t>> inputs,
                               const SimulatedDriveOptions& options,
                               std::shared_ptr<GuidingHand> hand)
    : inputs_(std::move(inputs)),
      hand_(std::move(hand)),
      kept_(share_kept(options)),
      resolution_(at_least_zero(options.resolution, "resolution")),
      noise_(at_least_zero(options.noise, "noise")),
      random_(options.seed),
      position_(start),
      told_(start),
      measurement_{start, 0} {}

int SimulatedDrive::joints() const { return static_cast<int>(position_.size()); }

Measurement SimulatedDrive::enable() {
  told_ = position_;
  measurement_.q = position_;
  return measurement_;
}

DriveStatus SimulatedDrive::exchange(const Setpoint& setpoint, Measurement& measurement) noexcept {
  if (inputs_ != nullptr) measurement_.inputs = inputs_->load(std::memory_order_acquire);
  const bool is_guided = hand_ != nullptr && hand_->take(position_);
  if (is_guided) {
    measurement_.q = position_;
  } else {
    position_ = told_ + kept_ * (position_ - told_);
    read_encoders();
  }
  // Where the hand leaves the arm it stays until it is told to be elsewhere.
  told_ = is_guided ? position_ : setpoint.q;
  measurement = measurement_;
  return is_guided ? DriveStatus::kGuided : DriveStatus::kOk;
}

void SimulatedDrive::release() noexcept {}

void SimulatedDrive::read_encoders() noexcept {
  measurement_.q = position_;
  for (double& q : measurement_.q) {
    if (noise_ > 0.0) q += noise_ * unit_normal_(random_);
    if (resolution_ > 0.0) q = resolution_ * std::round(q / resolution_);
  }
}

}  // namespace viapoint
