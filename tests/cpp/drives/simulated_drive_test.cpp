#include "viapoint/drives/simulated_drive.hpp"

#include <gtest/gtest.h>

namespace viapoint {
namespace {

TEST(SimulatedDrive, IsWhereItWasToldOneCycleBefore) {
  const JointVector start = JointVector::Constant(3, 0.5);
  SimulatedDrive drive(start);
  EXPECT_EQ(drive.joints(), 3);
  EXPECT_EQ(drive.enable().q, start);
  Setpoint setpoint;
  Measurement measurement;
  setpoint.q = JointVector::Constant(3, 1.0);
  EXPECT_EQ(drive.exchange(setpoint, measurement), DriveStatus::kOk);
  EXPECT_EQ(measurement.q, start);
  setpoint.q = JointVector::Constant(3, 2.0);
  EXPECT_EQ(drive.exchange(setpoint, measurement), DriveStatus::kOk);
  EXPECT_EQ(measurement.q, JointVector::Constant(3, 1.0));
}

TEST(SimulatedDrive, StaysWhereItIsWhenEnabledAgain) {
  SimulatedDrive drive(JointVector::Zero(1));
  Setpoint setpoint;
  Measurement measurement;
  setpoint.q = JointVector::Constant(1, 1.0);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(drive.exchange(setpoint, measurement), DriveStatus::kOk);
  drive.release();
  EXPECT_EQ(drive.enable().q, JointVector::Constant(1, 1.0));
}

}  // namespace
}  // namespace viapoint
