// Angles of many directions at once, against the standard library's arctangent.
#include "kinematics/angle_lanes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

double angle_of(double sine, double cosine) {
  double angle = 0.0;
  angles_of({&sine, 1}, {&cosine, 1}, {&angle, 1});
  return angle;
}

TEST(AnglesOf, AreThoseOfTheStandardLibraryToRounding) {
  constexpr size_t kCount = 24;
  std::mt19937_64 generator(101);
  std::uniform_real_distribution<double> turn(-kPi, kPi);
  std::uniform_real_distribution<double> decade(-12.0, 6.0);
  for (int problem = 0; problem < 50'000; ++problem) {
    SCOPED_TRACE(testing::Message() << "seed 101 problem " << problem);
    std::array<double, kCount> sines;
    std::array<double, kCount> cosines;
    std::array<double, kCount> angles;
    for (size_t i = 0; i < kCount; ++i) {
      const double length = std::pow(10.0, decade(generator));
      const double angle = turn(generator);
      sines[i] = length * std::sin(angle);
      cosines[i] = length * std::cos(angle);
    }
    angles_of(sines, cosines, angles);
    for (size_t i = 0; i < kCount; ++i) {
      const double expected = std::atan2(sines[i], cosines[i]);
      ASSERT_NEAR(angles[i], expected, 1e-15 * std::min(1.0, std::abs(expected)))
          << sines[i] << " " << cosines[i];
    }
  }
}

TEST(AnglesOf, KeepSmallAnglesToTheirOwnDigits) {
  for (double sine = 1.0; sine > 1e-300; sine *= 0.37) {
    EXPECT_NEAR(angle_of(sine, 1.0) / std::atan2(sine, 1.0), 1.0, 4e-16);
    EXPECT_NEAR(angle_of(-sine, 1.0) / std::atan2(-sine, 1.0), 1.0, 4e-16);
  }
}

TEST(AnglesOf, MeetTheAxesAndDiagonalsExactly) {
  for (int eighth = -4; eighth <= 4; ++eighth) {
    const double sine = eighth % 4 == 0 ? 0.0 : (eighth > 0 ? 1.0 : -1.0);
    const double cosine = std::abs(eighth) == 2 ? 0.0 : (std::abs(eighth) > 2 ? -1.0 : 1.0);
    const double signed_sine = eighth == -4 ? -0.0 : sine;
    EXPECT_EQ(angle_of(signed_sine, cosine), std::atan2(signed_sine, cosine)) << eighth;
  }
  EXPECT_EQ(angle_of(0.0, 0.0), 0.0);
}

}  // namespace
}  // namespace viapoint
