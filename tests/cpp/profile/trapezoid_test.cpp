#include "viapoint/profile/trapezoid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "golden.hpp"
#include "problem_count.hpp"
#include "profile/law_checks.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

void expect_rest_to_rest(const Trapezoid& law, double q0, double q1) {
  const double size = 1e-13 * (std::abs(q0) + std::abs(q1));
  EXPECT_EQ(law.law.at(0.0).q, q0);
  EXPECT_EQ(law.law.at(0.0).qd, 0.0);
  const AxisState end = law.law.at(law.law.end());
  EXPECT_NEAR(end.q, q1, size);
  EXPECT_NEAR(end.qd, 0.0, 1e-12 * std::abs(law.velocity));
  expect_continuous(law.law, 1);
  expect_extremes_hold(law.law);
}

TEST(Lspb, GoldenTextbookSection1) {
  const auto wanted = golden("lspb_0_to_1_18s");
  EXPECT_NEAR(lspb_with_blend_time(0.0, 1.0, 18.0, 6.0).velocity,
              wanted.at("tb_6_gives_V").get<double>(), 1e-15);
  EXPECT_NEAR(lspb_with_velocity(0.0, 1.0, 18.0, 0.06).blend_time,
              wanted.at("V_0_06_tb").get<double>(), 1e-12);
  EXPECT_NEAR(lspb_with_velocity(0.0, 1.0, 18.0, 0.11).blend_time,
              wanted.at("V_0_11_tb").get<double>(), 1e-12);
  EXPECT_EQ(lspb(0.0, 1.0, 18.0).blend_time, 6.0);
}

TEST(Lspb, GoldenTextbookSection1RefusesAVelocityOutsideItsRangeAndNamesIt) {
  const auto range = golden("lspb_0_to_1_18s").at("V_range_open_closed");
  const double open = range[0].get<double>(), closed = range[1].get<double>();
  for (const double velocity :
       {0.02, 1.0 / 18.0, std::nextafter(2.0 / 18.0, 1.0), 0.2, -0.06, 0.0, std::nan("")}) {
    SCOPED_TRACE(velocity);
    try {
      static_cast<void>(lspb_with_velocity(0.0, 1.0, 18.0, velocity));
      ADD_FAILURE() << "accepted";
    } catch (const MotionError& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
      EXPECT_NE(what.find("0.05555556"), std::string::npos) << what;
      EXPECT_NE(what.find("0.1111111"), std::string::npos) << what;
    }
  }
  EXPECT_NO_THROW(static_cast<void>(lspb_with_velocity(0.0, 1.0, 18.0, open * 1.0001)));
  EXPECT_NEAR(lspb_with_velocity(0.0, 1.0, 18.0, closed).blend_time, 9.0, 1e-12);
}

TEST(Lspb, MirrorsForMovesDownwards) {
  const Trapezoid up = lspb_with_velocity(1.0, 3.0, 2.0, 1.5);
  const Trapezoid down = lspb_with_velocity(3.0, 1.0, 2.0, -1.5);
  EXPECT_EQ(up.blend_time, down.blend_time);
  EXPECT_EQ(up.acceleration, -down.acceleration);
  EXPECT_NEAR(up.law.at(0.7).q, 4.0 - down.law.at(0.7).q, 1e-15);
  EXPECT_THROW(static_cast<void>(lspb_with_velocity(3.0, 1.0, 2.0, 1.5)), MotionError);
}

TEST(Lspb, RefusesBlendTimesThatDoNotFit) {
  EXPECT_THROW(static_cast<void>(lspb_with_blend_time(0.0, 1.0, 2.0, 0.0)), MotionError);
  EXPECT_THROW(static_cast<void>(lspb_with_blend_time(0.0, 1.0, 2.0, 1.01)), MotionError);
  EXPECT_THROW(static_cast<void>(lspb(0.0, 1.0, 0.0)), MotionError);
  EXPECT_THROW(static_cast<void>(lspb(0.0, INFINITY, 1.0)), MotionError);
  EXPECT_THROW(static_cast<void>(lspb_with_velocity(1.0, 1.0, 1.0, 1.0)), MotionError);
}

TEST(Lspb, RestsWhereThereIsNothingToMove) {
  const Trapezoid law = lspb(2.0, 2.0, 3.0);
  EXPECT_EQ(law.velocity, 0.0);
  EXPECT_EQ(law.law.at(1.5).q, 2.0);
}

TEST(Lspb, RunsFromRestToRestInTheGivenTime) {
  for (int seed = 0; seed < problems(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-5.0, 5.0), share(0.01, 1.0);
    const double q0 = any(random), q1 = any(random), time = std::exp(any(random));
    const double velocity = (q1 - q0) / time * (1.0 + share(random));
    const Trapezoid by_velocity = lspb_with_velocity(q0, q1, time, velocity);
    EXPECT_EQ(by_velocity.velocity, velocity);
    EXPECT_NEAR(by_velocity.law.duration(), time, 1e-14 * time);
    expect_rest_to_rest(by_velocity, q0, q1);
    const double blend = 0.5 * time * share(random);
    const Trapezoid by_blend = lspb_with_blend_time(q0, q1, time, blend);
    EXPECT_EQ(by_blend.blend_time, blend);
    expect_rest_to_rest(by_blend, q0, q1);
    expect_rest_to_rest(lspb(q0, q1, time), q0, q1);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(BangBang, GoldenTextbookSection1) {
  const auto wanted = golden("bang_bang_0_to_1_a_4");
  const Trapezoid law = bang_bang(0.0, 1.0, 4.0);
  EXPECT_EQ(law.blend_time, wanted.at("ts").get<double>());
  EXPECT_EQ(law.law.end(), wanted.at("tf").get<double>());
  EXPECT_EQ(law.velocity, wanted.at("v_peak").get<double>());
  EXPECT_EQ(law.law.extremes(1).high, wanted.at("v_peak").get<double>());
  EXPECT_EQ(law.law.parts().size(), 2u);
  expect_rest_to_rest(law, 0.0, 1.0);
}

TEST(BangBang, HoldsItsAccelerationBothWays) {
  const Trapezoid law = bang_bang(1.0, -2.0, 3.0);
  EXPECT_NEAR(law.law.extremes(2).low, -3.0, 1e-14);
  EXPECT_NEAR(law.law.extremes(2).high, 3.0, 1e-14);
  EXPECT_NEAR(law.law.end(), 2.0, 1e-14);
  expect_rest_to_rest(law, 1.0, -2.0);
  EXPECT_THROW(static_cast<void>(bang_bang(0.0, 1.0, 0.0)), MotionError);
  EXPECT_THROW(static_cast<void>(bang_bang(1.0, 1.0, 1.0)), MotionError);
}

TEST(QuickestTrapezoid, IsAtALimitAllTheTime) {
  for (int seed = 0; seed < problems(5000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-3.0, 3.0), decades(-3.0, 3.0);
    const double q0 = any(random), q1 = any(random);
    const double v = std::pow(10.0, decades(random)), a = std::pow(10.0, decades(random));
    const Trapezoid move = quickest_trapezoid(q0, q1, v, a);
    EXPECT_NEAR(move.law.at(move.law.end()).q, q1, 1e-12 * (std::abs(q0) + std::abs(q1)));
    expect_continuous(move.law, 1);
    EXPECT_NEAR(std::abs(move.acceleration), a, 1e-12 * a);
    EXPECT_LE(std::abs(move.velocity), v * (1.0 + 1e-15));
    const bool cruises = move.law.parts().size() == 3;
    EXPECT_EQ(std::abs(move.velocity) == v, cruises);
    EXPECT_EQ(cruises, v * v / a < std::abs(q1 - q0));
    if (testing::Test::HasFailure()) return;
  }
}

TEST(QuickestTrapezoid, RefusesLimitsThatAreNotPositive) {
  EXPECT_THROW(static_cast<void>(quickest_trapezoid(0, 1, 0, 1)), MotionError);
  EXPECT_THROW(static_cast<void>(quickest_trapezoid(0, 1, 1, -1)), MotionError);
  EXPECT_THROW(static_cast<void>(quickest_trapezoid(1, 1, 1, 1)), MotionError);
}

}  // namespace
}  // namespace viapoint
