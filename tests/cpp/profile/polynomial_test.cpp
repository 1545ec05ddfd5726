#include "viapoint/profile/polynomial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "golden.hpp"
#include "problem_count.hpp"
#include "profile/law_checks.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

void expect_coefficients(const Polynomial& law, const nlohmann::json& coefficients) {
  for (size_t k = 0; k < 6; ++k) {
    const double wanted = k < coefficients.size() ? coefficients[k].get<double>() : 0.0;
    EXPECT_NEAR(law.c[k], wanted, 1e-12 * (1.0 + std::abs(wanted)) + 1e-12) << "power " << k;
  }
}

TEST(Cubic, GoldenTextbookSection1) {
  const Polynomial law = cubic({10.0}, {-20.0}, 0.0, 1.0);
  expect_coefficients(law, golden("cubic_10_to_-20_deg_1s").at("coeffs"));
  // qd = 6Δ t − 6Δ t² and qdd = 6Δ − 12Δ t with Δ = −30.
  EXPECT_NEAR(law.at(0.25).qd, 6.0 * -30.0 * (0.25 - 0.0625), 1e-12);
  EXPECT_NEAR(law.at(0.25).qdd, -30.0 * (6.0 - 12.0 * 0.25), 1e-12);
}

TEST(Cubic, GoldenTextbookSection1TwoLink) {
  const auto& two_link = golden("two_link_1_2_from_3_0_to_2_2");
  const double first = two_link.at("chosen")[0], second = two_link.at("chosen")[1];
  expect_coefficients(cubic({0.0}, {first}, 0.0, 2.0), two_link.at("cubic_2s_joint1"));
  expect_coefficients(cubic({0.0}, {second}, 0.0, 2.0), two_link.at("cubic_2s_joint2"));
}

TEST(Quintic, GoldenTextbookSection1) {
  expect_coefficients(quintic({0.0}, {40.0}, 0.0, 2.0),
                      golden("quintic_0_to_40_deg_2s").at("coeffs"));
  expect_coefficients(quintic({0.0}, {1.0}, 0.0, 5.0),
                      golden("quintic_0_to_1_rad_5s").at("coeffs"));
}

TEST(Quintic, GoldenTextbookSection1FindsTheOvershootInsideTheInterval) {
  for (const auto& [key, time] :
       {std::pair{"quintic_0_to_1_v0_5_tf_1", 1.0}, std::pair{"quintic_0_to_1_v0_5_tf_5", 5.0}}) {
    SCOPED_TRACE(key);
    const auto wanted = golden(key);
    const Polynomial law = quintic({0.0, 5.0}, {1.0}, 0.0, time);
    expect_coefficients(law, wanted.at("coeffs"));
    const Extremes range = law.extremes(0);
    EXPECT_NEAR(range.high, wanted.at("peak").get<double>(), 1e-11);
    EXPECT_NEAR(range.high_time, wanted.at("t_peak").get<double>(), 1e-5);
    EXPECT_GT(range.high, 1.0);
    EXPECT_NEAR(law.at(range.high_time).qd, 0.0, 1e-13);
  }
}

TEST(Polynomial, MeetsItsBoundaryStatesFromAnyStartTime) {
  for (int seed = 0; seed < problems(5000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-10.0, 10.0);
    const double t0 = 10.0 * any(random), t1 = t0 + std::exp(0.3 * any(random));
    const AxisState from{any(random), any(random), any(random)};
    const AxisState to{any(random), any(random), any(random)};
    const double size = 1e-11 * (1.0 + 1.0 / std::pow(t1 - t0, 2));
    const Polynomial five = quintic(from, to, t0, t1);
    const Polynomial three = cubic(from, to, t0, t1);
    for (const Polynomial& law : {five, three}) {
      EXPECT_EQ(law.at(t0).q, from.q);
      EXPECT_EQ(law.at(t0).qd, from.qd);
      EXPECT_NEAR(law.at(t1).q, to.q, 10.0 * size);
      EXPECT_NEAR(law.at(t1).qd, to.qd, 10.0 * size);
      expect_extremes_hold(AxisLaw({law}));
    }
    EXPECT_EQ(five.at(t0).qdd, from.qdd);
    EXPECT_NEAR(five.at(t1).qdd, to.qdd, 100.0 * size * (1.0 + 1.0 / (t1 - t0)));
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Polynomial, ExtremesAreWhereTheDerivativeVanishes) {
  // q = x³ − 0.75 x on [−1, 1] (t0 = 4): extremes ±0.25 at ∓0.5, and the same at the ends.
  Polynomial law{4.0, 6.0, {-0.25, 2.25, -3.0, 1.0, 0.0, 0.0}};
  const Extremes velocity = law.extremes(1);
  EXPECT_NEAR(velocity.low, -0.75, 1e-15);
  EXPECT_NEAR(velocity.low_time, 5.0, 1e-12);
  EXPECT_NEAR(velocity.high, 2.25, 1e-15);
  const Extremes position = law.extremes(0);
  EXPECT_NEAR(position.low, -0.25, 1e-15);
  EXPECT_NEAR(position.high, 0.25, 1e-15);
  EXPECT_EQ(law.extremes(3).low, 6.0);
  EXPECT_EQ(law.extremes(3).high, 6.0);
}

TEST(Polynomial, RefusesWhatIsNoInterval) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(cubic({0.0}, {1.0}, 1.0, 1.0)), MotionError);
  EXPECT_THROW(static_cast<void>(quintic({0.0}, {1.0}, 2.0, 1.0)), MotionError);
  EXPECT_THROW(static_cast<void>(quintic({nan}, {1.0}, 0.0, 1.0)), MotionError);
  EXPECT_THROW(static_cast<void>(cubic({0.0}, {1.0}, 0.0, nan)), MotionError);
  try {
    static_cast<void>(cubic({0.0}, {1.0}, 3.0, 2.0));
    FAIL();
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    EXPECT_NE(std::string(error.what()).find("2 s"), std::string::npos) << error.what();
  }
}

TEST(AxisLaw, RefusesPartsThatDoNotMeetAndTimesOutside) {
  const Polynomial first = cubic({0.0}, {1.0}, 0.0, 1.0);
  EXPECT_THROW(AxisLaw({first, cubic({1.0}, {2.0}, 1.5, 2.0)}), MotionError);
  EXPECT_THROW(AxisLaw(std::vector<Polynomial>{}), MotionError);
  EXPECT_THROW(AxisLaw(JerkProfile{}), MotionError);
  const AxisLaw law({first, cubic({1.0}, {2.0}, 1.0, 2.0)});
  EXPECT_EQ(law.at(2.0 + 1e-15).q, 2.0);
  EXPECT_THROW(static_cast<void>(law.at(2.001)), MotionError);
  EXPECT_THROW(static_cast<void>(law.at(-0.001)), MotionError);
  EXPECT_THROW(static_cast<void>(law.at(std::nan(""))), MotionError);
}

TEST(AxisLaw, FollowsAJerkProfile) {
  for (int seed = 0; seed < problems(2000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> exponent(-2.0, 2.0);
    const auto any = [&] { return std::pow(10.0, exponent(random)); };
    const double velocity = any(), acceleration = any(), jerk = any();
    const JerkProfile profile = rest_to_rest(-any(), velocity, acceleration, jerk);
    const AxisLaw law(profile);
    EXPECT_NEAR(law.end(), profile.total(), 1e-14 * profile.total());
    expect_continuous(law, 2);
    expect_extremes_hold(law);
    const double size = std::abs(law.at(law.end()).q);
    for (int i = 0; i <= 20; ++i) {
      const double t = law.end() * i / 20.0;
      EXPECT_NEAR(law.at(t).q, profile.at(t).q, 1e-12 * size);
    }
    EXPECT_LE(law.extremes(1).high, velocity * (1.0 + 1e-12));
    EXPECT_GE(law.extremes(2).low, -acceleration * (1.0 + 1e-12));
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace viapoint
