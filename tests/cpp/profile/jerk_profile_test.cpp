#include "viapoint/profile/jerk_profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "problem_count.hpp"

namespace viapoint {
namespace {

constexpr double kSlack = 1e-12;

struct Peaks {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
};

/// States at the starts of the phases and at the end, integrated phase by phase with more digits
/// than the profile's own: a clock of doubles cannot address a phase 1e-16 of the whole long.
std::vector<AxisState> states_of(const JerkProfile& profile) {
  std::vector<AxisState> states{profile.start};
  long double q = profile.start.q, qd = profile.start.qd, qdd = profile.start.qdd;
  for (int i = 0; i < profile.phases; ++i) {
    const long double t = profile.duration[static_cast<size_t>(i)];
    const long double j = profile.jerk[static_cast<size_t>(i)];
    q += t * (qd + t * (qdd / 2 + j * t / 6));
    qd += t * (qdd + j * t / 2);
    qdd += j * t;
    states.push_back({static_cast<double>(q), static_cast<double>(qd), static_cast<double>(qdd),
                      static_cast<double>(j)});
  }
  return states;
}

/// Exact: |q̇| peaks where q̈ = 0 or at phase ends, |q̈| at phase ends.
Peaks peaks_of(const JerkProfile& profile) {
  Peaks peaks;
  const std::vector<AxisState> states = states_of(profile);
  for (size_t phase = 0; phase + 1 < states.size(); ++phase) {
    const AxisState& from = states[phase];
    const double j = profile.jerk[phase];
    peaks.jerk = std::max(peaks.jerk, std::abs(j));
    const auto look = [&](double tau) {
      peaks.acceleration = std::max(peaks.acceleration, std::abs(from.qdd + j * tau));
      peaks.velocity =
          std::max(peaks.velocity, std::abs(from.qd + tau * (from.qdd + 0.5 * j * tau)));
    };
    look(0.0);
    look(profile.duration[phase]);
    if (j != 0.0) look(std::clamp(-from.qdd / j, 0.0, profile.duration[phase]));
  }
  return peaks;
}

struct Move {
  double distance, velocity, acceleration, jerk;
};

void expect_sound(const Move& move) {
  const JerkProfile profile =
      rest_to_rest(move.distance, move.velocity, move.acceleration, move.jerk);
  const double total = profile.total();
  ASSERT_TRUE(std::isfinite(total));
  ASSERT_GT(total, 0.0);
  ASSERT_GE(profile.phases, 4);
  ASSERT_LE(profile.phases, 7);
  const AxisState first = profile.at(0.0);
  EXPECT_EQ(first.q, 0.0);
  EXPECT_EQ(first.qd, 0.0);
  EXPECT_EQ(first.qdd, 0.0);
  const Peaks peaks = peaks_of(profile);
  for (const AxisState& end : {profile.at(total), states_of(profile).back()}) {
    EXPECT_LE(std::abs(end.q - move.distance), kSlack * std::abs(move.distance));
    EXPECT_LE(std::abs(end.qd), kSlack * peaks.velocity);
    EXPECT_LE(std::abs(end.qdd), kSlack * peaks.acceleration);
  }
  EXPECT_LE(peaks.velocity, move.velocity * (1.0 + kSlack));
  EXPECT_LE(peaks.acceleration, move.acceleration * (1.0 + kSlack));
  EXPECT_LE(peaks.jerk, move.jerk);
  for (int i = 0; i < profile.phases; ++i) {
    EXPECT_GT(profile.duration[static_cast<size_t>(i)], 0.0);
  }
}

/// Pontryagin's conditions for this chain of integrators: jerk at its limit, or zero with velocity
/// or acceleration at its own. A profile that meets them from rest to rest is the quickest.
void expect_optimal(const Move& move) {
  const JerkProfile profile =
      rest_to_rest(move.distance, move.velocity, move.acceleration, move.jerk);
  const std::vector<AxisState> states = states_of(profile);
  for (size_t phase = 0; phase + 1 < states.size(); ++phase) {
    if (profile.jerk[phase] != 0.0) {
      EXPECT_EQ(std::abs(profile.jerk[phase]), move.jerk);
    } else {
      const AxisState& state = states[phase];
      const bool at_a =
          std::abs(std::abs(state.qdd) - move.acceleration) <= kSlack * move.acceleration;
      const bool at_v = std::abs(std::abs(state.qd) - move.velocity) <= kSlack * move.velocity;
      EXPECT_TRUE(at_a || at_v) << "phase " << phase << " idles below every limit";
    }
  }
}

double log_uniform(std::mt19937_64& random, double low, double high) {
  return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(random));
}

TEST(RestToRest, KeepsLimitsAndEndsExactlyOverDecades) {
  for (int seed = 0; seed < problems(20000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    Move move{log_uniform(random, 1e-12, 1e9), log_uniform(random, 1e-6, 1e9),
              log_uniform(random, 1e-6, 1e9), log_uniform(random, 1e-6, 1e9)};
    if (random() % 2 == 0) move.distance = -move.distance;
    expect_sound(move);
    expect_optimal(move);
    if (HasFailure()) return;
  }
}

TEST(RestToRest, KeepsLimitsOnEverydayMoves) {
  for (int seed = 0; seed < problems(20000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double velocity = log_uniform(random, 0.1, 10.0);
    const Move move{log_uniform(random, 1e-4, 6.0), velocity,
                    velocity * log_uniform(random, 0.5, 50.0),
                    velocity * log_uniform(random, 5.0, 5000.0)};
    expect_sound(move);
    expect_optimal(move);
    if (HasFailure()) return;
  }
}

TEST(RestToRest, SurvivesTinyAndHugeDistances) {
  for (const double distance : {1e-300, 1e-100, 1e-30, 1e-15, 1e15, 1e30, 1e100}) {
    SCOPED_TRACE(distance);
    expect_sound({distance, 1.0, 10.0, 100.0});
    expect_sound({-distance, 1e-6, 1e9, 1e-6});
    expect_sound({distance, 1e9, 1e-6, 1e9});
  }
}

TEST(RestToRest, DoesNothingOverZeroDistance) {
  const JerkProfile profile = rest_to_rest(0.0, 1.0, 1.0, 1.0);
  EXPECT_EQ(profile.phases, 0);
  EXPECT_EQ(profile.total(), 0.0);
  EXPECT_EQ(profile.at(1.0).q, 0.0);
  EXPECT_EQ(profile.at(1.0).qd, 0.0);
}

TEST(RestToRest, UsesSevenPhasesWhereEveryLimitIsReached) {
  // t_j = a/j = 1, t_a = v/a - t_j = 1, ramps cover v (2 t_j + t_a) = 6, cruise 4/2.
  const JerkProfile profile = rest_to_rest(10.0, 2.0, 1.0, 1.0);
  ASSERT_EQ(profile.phases, 7);
  for (const int i : {0, 1, 2, 4, 5, 6}) {
    EXPECT_NEAR(profile.duration[static_cast<size_t>(i)], 1.0, 1e-14);
  }
  EXPECT_NEAR(profile.duration[3], 2.0, 1e-14);
}

TEST(RestToRest, SkipsCruiseWhereVelocityIsNotReached) {
  // V² + V = 2 at a = j = 1, so V = 1, whose ramp is all jerk: t_a = 0.
  const JerkProfile exact = rest_to_rest(2.0, 5.0, 1.0, 1.0);
  EXPECT_NEAR(exact.total(), 4.0, 1e-14);
  // V² + V = 6, so V = 2: t_j = 1, t_a = 1, six phases of one second.
  const JerkProfile profile = rest_to_rest(6.0, 5.0, 1.0, 1.0);
  ASSERT_EQ(profile.phases, 6);
  EXPECT_NEAR(profile.total(), 6.0, 1e-14);
  EXPECT_NEAR(profile.at(3.0).qd, 2.0, 1e-14);
}

TEST(RestToRest, UsesJerkAloneOnShortMoves) {
  // Four jerk phases of t: 2 j t³ = d.
  const JerkProfile profile = rest_to_rest(-2.0, 100.0, 100.0, 1.0);
  ASSERT_EQ(profile.phases, 4);
  EXPECT_NEAR(profile.total(), 4.0, 1e-14);
  EXPECT_NEAR(profile.at(2.0).qd, -1.0, 1e-14);
  EXPECT_NEAR(profile.at(1.0).qdd, -1.0, 1e-14);
}

TEST(RestToRest, SkipsConstantAccelerationWhereVelocityComesFirst) {
  // t_j = √(v/j) = 1; the ramps cover 2; cruise 3.
  const JerkProfile profile = rest_to_rest(5.0, 1.0, 100.0, 1.0);
  ASSERT_EQ(profile.phases, 5);
  EXPECT_NEAR(profile.total(), 7.0, 1e-14);
}

TEST(JerkProfile, ClampsTimeToItsEnds) {
  const JerkProfile profile = rest_to_rest(1.0, 1.0, 1.0, 1.0);
  EXPECT_EQ(profile.at(-1.0).q, 0.0);
  EXPECT_NEAR(profile.at(profile.total() + 1.0).q, 1.0, 1e-14);
  EXPECT_NEAR(profile.at(profile.total() + 1.0).qd, 0.0, 1e-14);
  EXPECT_EQ(profile.at(std::nan("")).q, 0.0);
}

TEST(JerkProfile, DerivativesMatchFiniteDifferences) {
  const JerkProfile profile = rest_to_rest(1.7, 1.1, 2.3, 9.0);
  const double h = 1e-6;
  int compared = 0;
  for (double t = 0.01; t < profile.total() - 0.01; t += 0.0137) {
    const AxisState left = profile.at(t - h), here = profile.at(t), right = profile.at(t + h);
    if (left.qddd != right.qddd) continue;
    EXPECT_NEAR((right.q - left.q) / (2.0 * h), here.qd, 1e-8);
    EXPECT_NEAR((right.qd - left.qd) / (2.0 * h), here.qdd, 1e-8);
    EXPECT_NEAR((right.qdd - left.qdd) / (2.0 * h), here.qddd, 1e-7);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

}  // namespace
}  // namespace viapoint
