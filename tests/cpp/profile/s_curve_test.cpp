#include "viapoint/profile/s_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "profile/law_checks.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

TEST(SCurve, IsTheSevenPhasesFromWhereItStarts) {
  const AxisLaw law = s_curve(2.0, 0.5, 1.0, 3.0, 15.0);
  EXPECT_EQ(law.parts().size(), 7U);
  EXPECT_EQ(law.at(0.0).q, 2.0);
  EXPECT_NEAR(law.at(law.end()).q, 0.5, 1e-14);
  expect_continuous(law, 2);
  EXPECT_NEAR(law.extremes(1).low, -1.0, 1e-14);
  EXPECT_NEAR(law.extremes(2).low, -3.0, 1e-14);
  EXPECT_EQ(law.extremes(3).high, 15.0);
}

TEST(SCurve, RefusesWhatCannotBe) {
  EXPECT_THROW(static_cast<void>(s_curve(1, 1, 1, 1, 1)), MotionError);
  EXPECT_THROW(static_cast<void>(s_curve(0, 1, 0, 1, 1)), MotionError);
  EXPECT_THROW(static_cast<void>(s_curve(0, std::nan(""), 1, 1, 1)), MotionError);
  // A phase of 2.5e-324 s is none to a double, and without it the axis would stay where it is.
  EXPECT_THROW(static_cast<void>(s_curve(0, 1, 1, 2.2e-16, 9e307)), MotionError);
}

}  // namespace
}  // namespace viapoint
