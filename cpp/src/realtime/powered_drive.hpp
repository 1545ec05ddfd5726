/// @file
/// A drive whose power goes when its owner does.
#pragma once

#include <memory>
#include <utility>

#include "viapoint/realtime/drive.hpp"

namespace viapoint {

/// Enabled on construction, released on destruction, also when the loop cannot be built.
class PoweredDrive {
 public:
  explicit PoweredDrive(std::unique_ptr<Drive> drive)
      : drive_(std::move(drive)), start_(drive_->enable()) {}
  ~PoweredDrive() { release(); }
  /// Takes the power off, once.
  void release() {
    if (!std::exchange(released_, true)) drive_->release();
  }
  PoweredDrive(const PoweredDrive&) = delete;
  PoweredDrive& operator=(const PoweredDrive&) = delete;

  [[nodiscard]] Drive& drive() { return *drive_; }
  [[nodiscard]] const Drive& drive() const { return *drive_; }
  [[nodiscard]] const Measurement& start() const { return start_; }

 private:
  std::unique_ptr<Drive> drive_;
  Measurement start_;
  bool released_ = false;
};

}  // namespace viapoint
