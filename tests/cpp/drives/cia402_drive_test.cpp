// The worked example of docs/drives.md runs, over axes that power up step by step.
#include "drives/cia402_drive.hpp"

#include <gtest/gtest.h>

#include "realtime/no_allocation_scope.hpp"

namespace {

using viapoint::DriveStatus;

/// What the test does to the axes.
struct Axes {
  bool is_mute = false;
  std::uint16_t last = 0x40;  ///< state of all axes
  std::array<AxisFrame, 6> seen{};
};

class FakeBus final : public Bus {
 public:
  explicit FakeBus(std::shared_ptr<Axes> axes) : axes_(std::move(axes)) {}
  bool exchange(std::array<AxisFrame, 6>& frames) noexcept override {
    if (axes_->is_mute) return false;
    const std::uint16_t word = frames[0].control_word;
    if (axes_->last == 0x08 && word == 0x80) axes_->last = 0x40;
    if (axes_->last == 0x40 && word == 0x06) axes_->last = 0x21;
    if (axes_->last == 0x21 && word == 0x07) axes_->last = 0x33;
    if (axes_->last == 0x33 && word == 0x0f) axes_->last = 0x37;
    for (AxisFrame& frame : frames) {
      frame.status_word = axes_->last;
      frame.actual = frame.target;
    }
    axes_->seen = frames;
    return true;
  }

 private:
  std::shared_ptr<Axes> axes_;
};

TEST(Cia402Drive, PowersUpFromAFaultFollowsAndTellsItsTroubles) {
  const auto axes = std::make_shared<Axes>();
  axes->last = 0x08;
  Cia402Drive drive(std::make_unique<FakeBus>(axes), 1000.0);
  EXPECT_EQ(drive.enable().q, viapoint::JointVector::Zero(6));
  viapoint::Setpoint setpoint;
  setpoint.q = viapoint::JointVector::Constant(6, 0.5);
  viapoint::Measurement measurement;
  {
    const viapoint::NoAllocationScope scope;
    const DriveStatus status = drive.exchange(setpoint, measurement);
    const std::uint64_t calls = scope.calls();
    EXPECT_EQ(status, DriveStatus::kOk);
    EXPECT_EQ(calls, 0U);
  }
  EXPECT_EQ(axes->seen[5].target, 500);
  EXPECT_EQ(measurement.q, setpoint.q);
  axes->is_mute = true;
  EXPECT_EQ(drive.exchange(setpoint, measurement), DriveStatus::kSilent);
  axes->is_mute = false;
  axes->last = 0x27;  // voltage off
  EXPECT_EQ(drive.exchange(setpoint, measurement), DriveStatus::kPowerLost);
  EXPECT_EQ(drive.fault(), "the voltage is off");
  axes->last = 0x1f;
  EXPECT_EQ(drive.exchange(setpoint, measurement), DriveStatus::kFault);
  EXPECT_EQ(drive.fault(), "axis 1 has a fault, status word 31");
  drive.release();
  EXPECT_EQ(axes->seen[0].control_word, 0);
}

}  // namespace
