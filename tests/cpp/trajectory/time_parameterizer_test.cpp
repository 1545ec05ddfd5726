#include "viapoint/trajectory/time_parameterizer.hpp"

#include <gtest/gtest.h>

#include "trajectory/time_parameterizer_problems.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/profile/jerk_profile.hpp"

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

TEST(TimeParameterizer, KeepsLimitsOnRandomWalksWithCorners) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const int joints = 1 + static_cast<int>(seed % 7) + 1;
    const double size = decades(random, 1e-4, 10.0);
    const auto points = random_walk(random, joints, 2 + static_cast<int>(seed % 5), size, 5 * size);
    const JointPath path = cornered_path(points, 0.05 * size);
    const JointLimits limits = random_limits(random, joints, 2.0);
    expect_sound(path, limits, parameterize(path, limits), 20);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace viapoint::testing
