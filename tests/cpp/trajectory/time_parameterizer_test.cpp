#include "viapoint/trajectory/time_parameterizer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "problem_count.hpp"
#include "trajectory/time_parameterizer_problems.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/profile/jerk_profile.hpp"
#include "viapoint/trajectory/certificate.hpp"

namespace viapoint::testing {
namespace {

constexpr double kShare = 1.0 + 1e-9;

/// Ends of the path are met, at rest; pieces meet; each stays within its path piece.
void expect_sound(const JointPath& path, const JointLimits& limits,
                  const std::vector<TrajectoryPiece>& pieces, int samples) {
  ASSERT_FALSE(pieces.empty());
  const double size = path.pieces().front().coefficients.row(0).cwiseAbs().maxCoeff() +
                      path.pieces().back().coefficients.cwiseAbs().maxCoeff();
  const JointState first = pieces.front().at(0.0);
  const JointState last = pieces.back().at(pieces.back().duration);
  EXPECT_LE((first.q - path.at(0.0).q).cwiseAbs().maxCoeff(), 1e-15 * size);
  EXPECT_LE((last.q - path.at(path.length()).q).cwiseAbs().maxCoeff(), 1e-14 * size);
  for (const JointState& end : {first, last}) {
    EXPECT_LE(end.qd.cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LE(end.qdd.cwiseQuotient(limits.acceleration).cwiseAbs().maxCoeff(), 1e-6);
  }
  for (size_t k = 0; k + 1 < pieces.size(); ++k) {
    const JointState before = pieces[k].at(pieces[k].duration);
    const JointState after = pieces[k + 1].at(0.0);
    ASSERT_LE((after.q - before.q).cwiseAbs().maxCoeff(), 1e-13 * size) << "piece " << k;
    ASSERT_LE((after.qd - before.qd).cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff(), 1e-8)
        << "piece " << k;
    ASSERT_LE((after.qdd - before.qdd).cwiseQuotient(limits.acceleration).cwiseAbs().maxCoeff(),
              1e-6)
        << "piece " << k;
  }
  for (const TrajectoryPiece& piece : pieces) {
    double before = piece.timing[0];
    ASSERT_GE(before, -1e-15);
    for (int k = 1; k <= 10; ++k) {
      double u = 0.0;
      for (size_t power = 6; power-- > 0;) u = u * 0.1 * k + piece.timing[power];
      ASSERT_GE(u, before - 1e-12);
      before = u;
    }
    ASSERT_LE(before, 1.0 + 1e-12);
  }
  ASSERT_LE(sampled_share(pieces, limits, samples), kShare);
}

TEST(TimeParameterizer, TimesAStraightLineBySevenPhases) {
  const JointLimits limits = arm_limits();
  JointVector a = JointVector::Zero(6), b(6);
  b << 1.5, -0.4, 0.3, 1.0, -0.2, 0.7;
  JointPath path;
  path.append(JointPiece::line(a, b, 0.5));
  const auto pieces = parameterize(path, limits);
  EXPECT_LE(pieces.size(), 7u);
  const double speed = 1.0 / b.cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff();
  const JerkProfile exact = rest_to_rest(1.0, speed, 10.0 * speed, 100.0 * speed);
  EXPECT_NEAR(duration_of(pieces), exact.total(), 1e-9 * exact.total());
  expect_sound(path, limits, pieces, 200);
}

TEST(TimeParameterizer, RefusesAPathAlongWhichNothingMoves) {
  JointPath path;
  const JointVector q = JointVector::Constant(6, 0.3);
  path.append(JointPiece::line(q, q, 1.0));
  EXPECT_THROW((void)parameterize(path, arm_limits()), MotionError);
  EXPECT_THROW((void)parameterize(JointPath(), arm_limits()), MotionError);
}

/// Time of stopping at every point, under the same limits.
double stopping_time(const std::vector<JointVector>& points, const JointLimits& limits) {
  double sum = 0.0;
  for (size_t k = 0; k + 1 < points.size(); ++k) {
    const JointVector leg = points[k + 1] - points[k];
    const auto ceiling = [&leg](const JointVector& limit) {
      return 1.0 / leg.cwiseQuotient(limit).cwiseAbs().maxCoeff();
    };
    sum += rest_to_rest(1.0, ceiling(limits.velocity), ceiling(limits.acceleration),
                        ceiling(limits.jerk))
               .total();
  }
  return sum;
}

/// Seven phases under ceilings that hold all along the path: |q'|, |q''|, |q'''| at their sampled
/// largest, speed with half of the acceleration and a third of the jerk.
double uniformly_bounded_time(const JointPath& path, const JointLimits& limits) {
  const auto n = limits.joints();
  JointVector first = JointVector::Zero(n), second = first, third = first;
  for (const JointPiece& piece : path.pieces()) {
    for (int k = 0; k <= 50; ++k) {
      const PathPoint p = piece.at(piece.length * k / 50);
      first = first.cwiseMax(p.q1.cwiseAbs());
      second = second.cwiseMax(p.q2.cwiseAbs());
      third = third.cwiseMax(p.q3.cwiseAbs());
    }
  }
  // A hundredth more for what lies between the samples.
  first *= 1.01, second *= 1.01, third *= 1.01;
  double rate = 1e300, change = 1e300, jerk = 1e300;
  for (int i = 0; i < n; ++i) {
    rate = std::min({rate, limits.velocity[i] / first[i],
                     std::sqrt(0.5 * limits.acceleration[i] / second[i]),
                     std::cbrt(limits.jerk[i] / (3.0 * third[i]))});
  }
  for (int i = 0; i < n; ++i) {
    change = std::min({change, (limits.acceleration[i] - second[i] * rate * rate) / first[i],
                       limits.jerk[i] / (9.0 * second[i] * rate)});
  }
  for (int i = 0; i < n; ++i) {
    const double spent = third[i] * rate * rate * rate + 3.0 * second[i] * rate * change;
    jerk = std::min(jerk, (limits.jerk[i] - spent) / first[i]);
  }
  return rest_to_rest(path.length(), rate, change, jerk).total();
}

/// The proof of the trajectory's own checker.
void expect_certified(const std::vector<TrajectoryPiece>& pieces, const JointLimits& limits) {
  const Certificate certificate = certify(pieces, limits);
  for (const auto* extrema :
       {&certificate.velocity, &certificate.acceleration, &certificate.jerk}) {
    for (const Extremum& extremum : *extrema) EXPECT_LE(extremum.share, kShare);
  }
  EXPECT_TRUE(certificate.holds()) << certificate.problems.front().describe();
}

void expect_sound_and_quick(const JointPath& path, const JointLimits& limits, int samples) {
  const auto pieces = parameterize(path, limits);
  expect_sound(path, limits, pieces, samples);
  expect_certified(pieces, limits);
  EXPECT_LE(duration_of(pieces), uniformly_bounded_time(path, limits));
}

TEST(TimeParameterizer, KeepsLimitsOnRandomWalksWithCorners) {
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(1000); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const int joints = 2 + static_cast<int>(seed % 7);
    const double size = decades(random, 1e-6, 2.0);
    const auto points = random_walk(random, joints, 2 + static_cast<int>(seed % 5), size, 5 * size);
    const JointPath path = cornered_path(points, 0.05 * size);
    expect_sound_and_quick(path, random_limits(random, joints, 2.0), 20);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(TimeParameterizer, KeepsLimitsWhereLegsDifferByDecades) {
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(300); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const int joints = 2 + static_cast<int>(seed % 6);
    const auto points = random_walk(random, joints, 2 + static_cast<int>(seed % 6), 1e-3, 10.0);
    const JointPath path = cornered_path(points, decades(random, 1e-4, 0.1));
    expect_sound_and_quick(path, random_limits(random, joints, 1.0), 20);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(TimeParameterizer, KeepsLimitsOnRandomQuinticSplines) {
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(1000); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const int joints = 1 + static_cast<int>(seed % 7);
    const JointPath path = random_spline(random, joints, 1 + static_cast<int>(seed % 9),
                                         decades(random, 1e-6, 1.0), decades(random, 0.1, 3.0));
    expect_sound_and_quick(path, random_limits(random, joints, 1.5), 20);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(TimeParameterizer, KeepsScalesOfPieces) {
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(300); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const JointPath plain = cornered_path(random_walk(random, 6, 4, 0.1, 0.6), 0.01);
    JointPath path;
    for (JointPiece piece : plain.pieces()) {
      piece.scale = uniform(random, 0.1, 1.0);
      path.append(piece);
    }
    const JointLimits limits = arm_limits();
    const auto pieces = parameterize(path, limits);
    expect_sound(path, limits, pieces, 20);
    size_t index = 0;
    for (const TrajectoryPiece& piece : pieces) {
      // The path piece is known by its geometry.
      while (piece.path[0][0] != path.pieces()[index].coefficients(0, 0)) ++index;
      const JointPiece& geometry = path.pieces()[index];
      ASSERT_LE(sampled_share(std::vector{piece}, limits, 20), geometry.scale * kShare);
    }
  }
}

TEST(TimeParameterizer, PassesCornersInLessThanFourFifthsOfStopping) {
  for (const int count : {10, 100}) {
    std::vector<double> ratios;
    for (std::uint64_t seed = 0; seed < 9; ++seed) {
      Random random(seed);
      std::vector<JointVector> points{JointVector::Zero(6)};
      for (int k = 1; k < count; ++k) {
        points.push_back(points.back() + uniform(random, 0.1, 0.6) * direction(random, 6));
      }
      const auto pieces = parameterize(cornered_path(points, 0.01), arm_limits());
      ratios.push_back(duration_of(pieces) / stopping_time(points, arm_limits()));
    }
    std::sort(ratios.begin(), ratios.end());
    EXPECT_LE(ratios[ratios.size() / 2], 0.78) << count << " points";
  }
}

TEST(TimeParameterizer, DoesNotCareForTheScaleOfSThatPiecesComeIn) {
  const JointLimits limits = arm_limits();
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const JointPath plain = cornered_path(random_walk(random, 6, 6, 0.1, 0.6), 0.02);
    JointPath scaled;
    double scale = 1.0;
    for (JointPiece piece : plain.pieces()) {
      // As far as a thousand unequal corners get it.
      scale *= decades(random, 1e-6, 1e2);
      piece.length *= scale;
      scaled.append(piece);
    }
    const auto pieces = parameterize(scaled, limits);
    expect_sound(plain, limits, pieces, 20);
    expect_certified(pieces, limits);
    EXPECT_NEAR(duration_of(pieces) / duration_of(parameterize(plain, limits)), 1.0, 1e-6);
  }
}

TEST(TimeParameterizer, IsAboutAsQuickAsStoppingWhereCornersAreTiny) {
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(500); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const int joints = 2 + static_cast<int>(seed % 6);
    const auto points = random_walk(random, joints, 2, 1e-2, 5.0);
    const JointLimits limits = random_limits(random, joints, 1.0);
    const auto pieces = parameterize(cornered_path(points, decades(random, 1e-5, 1e-2)), limits);
    // A corner costs a little by itself, and two to three per cent are the optimiser's.
    EXPECT_LE(duration_of(pieces), 1.15 * stopping_time(points, limits));
  }
}

TEST(TimeParameterizer, IsAboutAsQuickAsTheSevenPhasesOnALineTimedAsACurve) {
  // Pieces that differ in scale by a hair, so that the general method runs.
  const JointLimits limits = arm_limits();
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const JointVector a = JointVector::Zero(6);
    const JointVector b = decades(random, 1e-3, 5.0) * direction(random, 6);
    const double cut = uniform(random, 0.2, 0.8);
    JointPath straight, halves;
    straight.append(JointPiece::line(a, b, 1.0));
    halves.append(JointPiece::line(a, cut * b, cut));
    JointPiece rest = JointPiece::line(cut * b, b, 1.0 - cut);
    rest.scale = 1.0 - 1e-9;
    halves.append(rest);
    const double quickest = duration_of(parameterize(straight, limits));
    const double timed = duration_of(parameterize(halves, limits));
    EXPECT_LE(timed, 1.03 * quickest);
    EXPECT_GE(timed, (1.0 - 1e-9) * quickest);
  }
}

}  // namespace
}  // namespace viapoint::testing
