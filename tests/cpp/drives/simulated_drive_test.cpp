#include "viapoint/drives/simulated_drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "realtime/no_allocation_scope.hpp"
#include "viapoint/core/error.hpp"

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

/// What `drive` measures of its one joint in a cycle that tells it to be at `q`.
double told(SimulatedDrive& drive, double q, DriveStatus status = DriveStatus::kOk) {
  Setpoint setpoint;
  setpoint.q = JointVector::Constant(1, q);
  Measurement measurement;
  EXPECT_EQ(drive.exchange(setpoint, measurement), status);
  return measurement.q[0];
}

TEST(SimulatedDrive, FollowsAStepWithItsTimeConstant) {
  SimulatedDriveOptions options;
  options.lag = 0.02;
  SimulatedDrive drive(JointVector::Zero(1), nullptr, options);
  EXPECT_EQ(told(drive, 1.0), 0.0);
  for (int k = 1; k <= 100; ++k) {
    EXPECT_NEAR(told(drive, 1.0), 1.0 - std::exp(-0.002 * k / 0.02), 1e-12) << k;
  }
}

TEST(SimulatedDrive, LagsBehindARampByItsTimeConstantAndHalfACycle) {
  SimulatedDriveOptions options;
  options.lag = 0.05;
  SimulatedDrive drive(JointVector::Zero(1), nullptr, options);
  double q = 0.0, measured = 0.0;
  for (int k = 0; k < 1000; ++k) measured = told(drive, q = 0.001 * k);
  // A setpoint that is held for a cycle h is late by h, and x = u - v h / (1 - e^(-h/T)).
  EXPECT_NEAR(q - measured, 0.001 / (1.0 - std::exp(-0.002 / 0.05)), 1e-9);
}

TEST(SimulatedDrive, ReadsWholeStepsOfItsEncoders) {
  SimulatedDriveOptions options;
  options.resolution = 0.25;
  SimulatedDrive drive(JointVector::Zero(1), nullptr, options);
  told(drive, 0.30);
  EXPECT_EQ(told(drive, 0.38), 0.25);
  EXPECT_EQ(told(drive, -0.13), 0.5);
  EXPECT_EQ(told(drive, 0.0), -0.25);
}

TEST(SimulatedDrive, ReadsNoiseOfItsSizeAndSeed) {
  SimulatedDriveOptions options;
  options.noise = 1e-3;
  options.seed = 5;
  SimulatedDrive drive(JointVector::Zero(1), nullptr, options);
  SimulatedDrive same(JointVector::Zero(1), nullptr, options);
  options.seed = 6;
  SimulatedDrive other(JointVector::Zero(1), nullptr, options);
  EXPECT_EQ(drive.enable().q[0], 0.0);
  constexpr int kReadings = 20'000;
  double sum = 0.0, squares = 0.0;
  int alike = 0;
  for (int k = 0; k < kReadings; ++k) {
    const double q = told(drive, 0.0);
    EXPECT_EQ(q, told(same, 0.0));
    alike += q == told(other, 0.0) ? 1 : 0;
    sum += q;
    squares += q * q;
  }
  EXPECT_EQ(alike, 0);
  // Four standard deviations of the estimates.
  EXPECT_NEAR(sum / kReadings, 0.0, 4.0 * 1e-3 / std::sqrt(kReadings));
  EXPECT_NEAR(std::sqrt(squares / kReadings), 1e-3, 4.0 * 1e-3 / std::sqrt(2.0 * kReadings));
}

TEST(SimulatedDrive, RefusesOptionsThatAreNone) {
  for (const double bad :
       {-1e-9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (double SimulatedDriveOptions::* option :
         {&SimulatedDriveOptions::lag, &SimulatedDriveOptions::resolution,
          &SimulatedDriveOptions::noise}) {
      SimulatedDriveOptions options;
      options.*option = bad;
      EXPECT_THROW(SimulatedDrive(JointVector::Zero(1), nullptr, options), MotionError);
    }
  }
}

TEST(SimulatedDrive, IsWhereAHandHoldsItUntilTheHandLetsGo) {
  auto hand = std::make_shared<GuidingHand>();
  SimulatedDriveOptions options;
  options.lag = 0.02;
  options.noise = 1e-3;
  SimulatedDrive drive(JointVector::Zero(1), nullptr, options, hand);
  EXPECT_FALSE(hand->guides());
  hand->guide({JointVector::Constant(1, 0.1), JointVector::Constant(1, 0.2)});
  EXPECT_THROW(hand->guide({JointVector::Zero(1)}), MotionError);
  EXPECT_EQ(told(drive, 0.0, DriveStatus::kGuided), 0.1);
  EXPECT_EQ(told(drive, 0.1, DriveStatus::kGuided), 0.2);
  EXPECT_TRUE(hand->guides());
  EXPECT_NEAR(told(drive, 0.2), 0.2, 6e-3);  // noise again; what it was told in between is gone
  EXPECT_FALSE(hand->guides());

  hand->guide(std::vector<JointVector>(100, JointVector::Constant(1, 0.3)));
  told(drive, 0.2, DriveStatus::kGuided);
  hand->let_go();
  told(drive, 0.3);
  EXPECT_FALSE(hand->guides());
  EXPECT_THROW(hand->guide({}), MotionError);
}

TEST(SimulatedDrive, ExchangesWithoutTheHeap) {
  auto hand = std::make_shared<GuidingHand>();
  SimulatedDriveOptions options;
  options.lag = 0.02;
  options.noise = 1e-3;
  options.resolution = 1e-4;
  SimulatedDrive drive(JointVector::Zero(6), nullptr, options, hand);
  hand->guide({JointVector::Zero(6)});
  Setpoint setpoint;
  setpoint.q = JointVector::Zero(6);
  Measurement measurement;
  const NoAllocationScope scope;
  int guided = 0;
  for (int k = 0; k < 10; ++k) {
    guided += drive.exchange(setpoint, measurement) == DriveStatus::kGuided ? 1 : 0;
  }
  const std::uint64_t calls = scope.calls();
  EXPECT_EQ(calls, 0U);
  EXPECT_EQ(guided, 1);
}

}  // namespace
}  // namespace viapoint
