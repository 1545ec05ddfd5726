#include "viapoint/trajectory/bernstein.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "problem_count.hpp"
#include "trajectory/trajectory_fixtures.hpp"
#include "viapoint/trajectory/bernstein_composition.hpp"

namespace viapoint {
namespace {

using testing::one_joint_piece;
using testing::random_piece;

BernsteinPolynomial polynomial(std::initializer_list<double> coefficients) {
  BernsteinPolynomial f(static_cast<int>(coefficients.size()) - 1);
  std::ranges::copy(coefficients, f.coefficients().begin());
  return f;
}

BernsteinPolynomial random_polynomial(std::mt19937_64& random) {
  std::uniform_int_distribution<int> degree(0, kMaxBernsteinDegree);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  BernsteinPolynomial f(degree(random));
  for (double& b : f.coefficients()) b = value(random);
  return f;
}

TEST(BernsteinPolynomial, EvaluatesTheParabola) {
  // 2 x (1 - x) by its middle coefficient.
  const auto f = polynomial({0.0, 1.0, 0.0});
  EXPECT_DOUBLE_EQ(f(0.25), 0.375);
  EXPECT_DOUBLE_EQ(f(0.5), 0.5);
  EXPECT_DOUBLE_EQ((-f)(0.5), -0.5);
}

TEST(BernsteinPolynomial, SplitHalvesAreTheSameCurve) {
  for (unsigned seed = 0; seed < problems(500U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto f = random_polynomial(random);
    auto lower = f;
    const auto upper = lower.split_off_upper_half();
    for (const double x : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      EXPECT_NEAR(lower(x), f(0.5 * x), 1e-14);
      EXPECT_NEAR(upper(x), f(0.5 + 0.5 * x), 1e-14);
    }
    EXPECT_EQ(lower.last(), upper.first());
  }
}

TEST(Raise, FindsTheTopOfAParabolaOffTheMiddle) {
  // 3 x (1-x)²: its top is at x = 1/3, where no halving ever ends.
  const auto f = polynomial({0.0, 1.0, 0.0, 0.0});
  Peak peak;
  const auto x = raise(peak, f, 1e-12);
  ASSERT_TRUE(x);
  EXPECT_NEAR(*x, 1.0 / 3.0, 1e-5);
  EXPECT_GE(peak.bound, 4.0 / 9.0 - 1e-16);
  EXPECT_LE(peak.bound, 4.0 / 9.0 + 2e-12);
  EXPECT_LE(peak.reached, peak.bound);
}

TEST(Raise, BoundIsNeverBelowASampleAndTight) {
  constexpr double kTolerance = 1e-10;
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto f = random_polynomial(random);
    Peak peak;
    const auto x = raise(peak, f, kTolerance);
    ASSERT_TRUE(x);
    EXPECT_NEAR(f(*x), peak.reached, 1e-13);
    // Coefficients are at most 1: the documented rounding of the halvings.
    EXPECT_LE(peak.bound, peak.reached + kTolerance + 1.4e-13);
    for (int i = 0; i <= 200; ++i) ASSERT_LE(f(i / 200.0), peak.bound + 1e-14) << i;
  }
}

TEST(Raise, LeavesThePlaceAloneWhenNothingIsHigher) {
  Peak peak;
  ASSERT_TRUE(raise(peak, polynomial({0.0, 4.0, 0.0}), 1e-10));
  const double before = peak.reached;
  EXPECT_FALSE(raise(peak, polynomial({0.0, 2.0, 0.0}), 1e-10));
  EXPECT_EQ(peak.reached, before);
}

TEST(Raise, AddsTheRoundingToTheBoundOnly) {
  Peak peak;
  raise(peak, polynomial({1.0, 1.0}), 1e-10, 0.25);
  EXPECT_EQ(peak.reached, 1.0);
  EXPECT_EQ(peak.bound, 1.25);
}

TEST(Raise, TakesWhatIsNotFiniteForUnbounded) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    Peak peak;
    raise(peak, polynomial({0.0, bad, 0.0}), 1e-10);
    EXPECT_TRUE(std::isinf(peak.bound));
  }
}

TEST(Raise, EndsWhereTheToleranceIsBelowRounding) {
  // No double lies within the tolerance of 1e16: the search must give up, with a true bound.
  Peak peak;
  raise(peak, polynomial({0.0, 1e16, -1e16, 1e16, 0.0}), 1e-30);
  EXPECT_GE(peak.bound, peak.reached);
  EXPECT_LE(peak.bound, peak.reached * (1 + 1e-12));
}

TEST(BernsteinComposition, AgreesWithTheChainRuleOfThePiece) {
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    TrajectoryPiece piece = random_piece(random, 1);
    piece.duration = 1.0;  // so that 1e-11 means the same for every order
    const BernsteinComposition composition(piece);
    BernsteinComposition::Path path{};
    for (std::size_t k = 0; k < 6; ++k) path[k] = piece.path[k][0];
    for (const double x : {0.0, 0.1, 0.37, 0.5, 0.81, 1.0}) {
      const JointState state = piece.at(x);
      EXPECT_NEAR(composition.of(path, 0)(x), state.q[0], 1e-13);
      EXPECT_NEAR(composition.of(path, 1)(x), state.qd[0], 1e-11);
      EXPECT_NEAR(composition.of(path, 2)(x), state.qdd[0], 1e-10);
      EXPECT_NEAR(composition.of(path, 3)(x), state.qddd[0], 1e-9);
    }
  }
}

TEST(BernsteinComposition, MagnitudeIsNoLessThanAnyCoefficientAndTightOnAStraightPath) {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < problems(2000); ++trial) {
    SCOPED_TRACE(trial);
    TrajectoryPiece piece = random_piece(random, 1);
    const bool straight = trial % 2 == 0;
    if (straight) {
      for (size_t k = 2; k < 6; ++k) piece.path[k][0] = 0.0;
    }
    const BernsteinComposition composition(piece);
    BernsteinComposition::Path path{};
    for (size_t k = 0; k < 6; ++k) path[k] = piece.path[k][0];
    for (int order = 0; order < 4; ++order) {
      const BernsteinPolynomial f = composition.of(path, order);
      const double largest = std::max(f.hull(), (-f).hull());
      const double magnitude = composition.magnitude(path, order);
      ASSERT_GE(magnitude, largest * (1.0 - 1e-14)) << order;
      if (straight && order > 0) {
        ASSERT_LE(magnitude, largest * (1.0 + 1e-14)) << order;
      }
    }
  }
}

TEST(BernsteinComposition, StaysAccurateFarFromZero) {
  // A micrometre's move at 10 m: the offset must not spoil the derivatives.
  const TrajectoryPiece piece =
      one_joint_piece(0.1, {10.0, 1e-6, 0, 0, 0, 0}, testing::kSmoothStep);
  const BernsteinComposition composition(piece);
  const BernsteinComposition::Path path = {10.0, 1e-6, 0, 0, 0, 0};
  const auto jerk = composition.of(path, 3);
  // d³/dτ³ of 1e-6 (10x³ - 15x⁴ + 6x⁵) at the start: 60e-6 / 0.1³.
  EXPECT_NEAR(jerk.first(), 60e-3, 1e-15);
  EXPECT_LT(composition.rounding(path, 3), 1e-12);
}

TEST(BernsteinComposition, KeepsItsDegreeLowWhereThePieceIsSimple) {
  const TrajectoryPiece line = one_joint_piece(1.0, {1, 2, 0, 0, 0, 0});
  const BernsteinComposition composition(line);
  EXPECT_EQ(composition.of({1, 2, 0, 0, 0, 0}, 0).degree(), 1);
  EXPECT_EQ(composition.of({1, 2, 0, 0, 0, 0}, 3).degree(), 0);
  const TrajectoryPiece full = one_joint_piece(1.0, {1, 2, 0, 0, 0, 1}, testing::kSmoothStep);
  EXPECT_EQ(BernsteinComposition(full).of({1, 2, 0, 0, 0, 1}, 0).degree(), kMaxBernsteinDegree);
}

TEST(BernsteinComposition, StandsStillWithoutTiming) {
  const TrajectoryPiece piece = one_joint_piece(1.0, {1, 2, 3, 0, 0, 0}, {0.5, 0, 0, 0, 0, 0});
  const BernsteinComposition composition(piece);
  EXPECT_DOUBLE_EQ(composition.of({1, 2, 3, 0, 0, 0}, 0)(0.3), 2.75);
  for (const int order : {1, 2, 3}) EXPECT_EQ(composition.of({1, 2, 3, 0, 0, 0}, order)(0.3), 0.0);
}

}  // namespace
}  // namespace viapoint
