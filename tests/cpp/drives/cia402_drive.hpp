/// @file
/// The worked example of docs/drives.md: an own drive, as far as it goes without a field bus.
#pragma once

// [docs/drives.md]
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/realtime/drive.hpp"

/// What a cycle of the bus carries for one axis (CiA 402, cyclic synchronous position mode).
struct AxisFrame {
  std::uint16_t control_word = 0;
  std::int32_t target = 0;  ///< counts
  std::uint16_t status_word = 0;
  std::int32_t actual = 0;  ///< counts
};

/// The master of the field bus. exchange() sends and fetches all axes at once, without waiting.
class Bus {
 public:
  virtual ~Bus() = default;
  virtual bool exchange(std::array<AxisFrame, 6>& axes) noexcept = 0;
};

class Cia402Drive final : public viapoint::Drive {
 public:
  Cia402Drive(std::unique_ptr<Bus> bus, double counts_per_radian)
      : bus_(std::move(bus)), counts_(counts_per_radian) {}

  int joints() const override { return 6; }

  // An ordinary thread, the loop at rest: this may wait, and may throw.
  viapoint::Measurement enable() override {
    for (int tries = 0; tries < 1000; ++tries) {
      if (!bus_->exchange(axes_)) continue;
      bool is_up = true;
      for (AxisFrame& axis : axes_) {
        const unsigned state = axis.status_word & 0x6fU;
        if ((state & 0x08U) != 0) {
          axis.control_word = 0x80;  // fault reset
        } else if (state == 0x40) {
          axis.control_word = 0x06;  // switch on disabled: shut down
        } else if (state == 0x21) {
          axis.control_word = 0x07;  // ready: switch on
        } else if (state == 0x23) {
          axis.control_word = 0x0f;  // switched on: enable
        }
        axis.target = axis.actual;  // nothing moves when the power comes
        is_up = is_up && state == 0x27;
      }
      if (is_up) return measured();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    throw viapoint::MotionError(viapoint::ErrorCode::kDriveFault, "the axes do not power up",
                                {"look at the drives' own displays"});
  }

  // The loop's thread, every cycle: no heap, no lock, no wait, no throw, no log.
  viapoint::DriveStatus exchange(const viapoint::Setpoint& setpoint,
                                 viapoint::Measurement& measurement) noexcept override {
    for (int i = 0; i < 6; ++i) {
      axes_[static_cast<std::size_t>(i)].target =
          static_cast<std::int32_t>(std::lround(setpoint.q[i] * counts_));
    }
    if (!bus_->exchange(axes_)) return viapoint::DriveStatus::kSilent;
    measurement = measured();
    for (const AxisFrame& axis : axes_) {
      if ((axis.status_word & 0x08U) != 0) return viapoint::DriveStatus::kFault;
      if ((axis.status_word & 0x10U) == 0) return viapoint::DriveStatus::kPowerLost;
    }
    return viapoint::DriveStatus::kOk;
  }

  // An ordinary thread again; it must not throw.
  void release() noexcept override {
    for (AxisFrame& axis : axes_) axis.control_word = 0;
    bus_->exchange(axes_);
  }

  // An ordinary thread, after exchange() has returned kFault or kPowerLost.
  std::string fault() const override {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      if ((axes_[i].status_word & 0x08U) == 0) continue;
      return "axis " + std::to_string(i + 1) + " has a fault, status word " +
             std::to_string(axes_[i].status_word);
    }
    return "the voltage is off";
  }

 private:
  viapoint::Measurement measured() const noexcept {
    viapoint::Measurement now{viapoint::JointVector(6), 0};  // on the stack: up to 16 joints
    for (int i = 0; i < 6; ++i) now.q[i] = axes_[static_cast<std::size_t>(i)].actual / counts_;
    return now;
  }

  std::unique_ptr<Bus> bus_;
  double counts_;
  std::array<AxisFrame, 6> axes_{};
};
// [docs/drives.md]
