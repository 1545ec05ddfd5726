#include "viapoint/trajectory/reachability_timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "problem_count.hpp"
#include "trajectory/time_parameterizer_problems.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/trajectory/certificate.hpp"
#include "viapoint/trajectory/time_parameterizer.hpp"

namespace viapoint::testing {
namespace {

constexpr unsigned kProblems = problems(1000U);

/// Jerk so high that the certificate has nothing to say of it.
JointLimits without_jerk(JointLimits limits) {
  limits.jerk.setConstant(1e12);
  return limits;
}

double worst_of(const std::vector<Extremum>& extrema) {
  double worst = 0.0;
  for (const Extremum& extremum : extrema) worst = std::max(worst, extremum.share);
  return worst;
}

TEST(ReachabilityTiming, KeepsVelocityAndAccelerationBetweenNodesOfAnyPath) {
  for (unsigned seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const int joints = 1 + static_cast<int>(seed % 7);
    const JointLimits limits = random_limits(random, joints, 1.0);
    const JointPath path =
        seed % 2 == 0 ? random_spline(random, joints, 6, decades(random, 0.1, 10.0), 0.5)
                      : cornered_path(random_walk(random, std::max(2, joints), 5, 0.1, 1.0), 0.01);
    const JointLimits fitting =
        seed % 2 == 0 ? limits : random_limits(random, std::max(2, joints), 1.0);
    const auto pieces = parameterize_without_jerk(path, fitting, 20);
    const Certificate certificate = certify(pieces, without_jerk(fitting));
    ASSERT_LE(worst_of(certificate.velocity), 1.0 + 1e-9);
    ASSERT_LE(worst_of(certificate.acceleration), 1.0 + 1e-9);
    // Something is used up somewhere.
    ASSERT_GE(std::max(worst_of(certificate.velocity), worst_of(certificate.acceleration)), 0.99);
    const JointVector reach = path.at(path.length()).q;
    const double size = 1.0 + reach.cwiseAbs().maxCoeff();
    ASSERT_LE(certificate.position_jump, 1e-10 * size);
    ASSERT_LE((pieces.front().at(0.0).q - path.at(0.0).q).norm(), 1e-12);
    ASSERT_LE((pieces.back().at(pieces.back().duration).q - reach).norm(), 1e-10 * size);
    for (int i = 0; i < fitting.joints(); ++i) {
      const double speed = std::max(std::abs(pieces.front().at(0.0).qd[i]),
                                    std::abs(pieces.back().at(pieces.back().duration).qd[i]));
      ASSERT_LE(speed, 1e-6 * fitting.velocity[i]);
    }
  }
}

TEST(ReachabilityTiming, IsNeverSlowerThanWithJerk) {
  for (unsigned seed = 0; seed < kProblems / 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const JointPath path = random_spline(random, 4, 5, 1.0, 0.5);
    const JointLimits limits = random_limits(random, 4, 0.3);
    const double with_jerk = duration_of(parameterize(path, limits));
    ASSERT_LE(duration_of(parameterize_without_jerk(path, limits)), 1.001 * with_jerk);
  }
}

/// Acceleration rules nearly everywhere here, between nodes as well as at them.
TEST(ReachabilityTiming, IsHardlyQuickerThanWithAJerkThatHardlyRules) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const JointPath path = random_spline(random, 4, 8, 1.0, 0.3);
    const JointVector v = JointVector::Constant(4, 2.0);
    const JointLimits limits = limits_of(v, 5.0 * v, 2500.0 * v);
    const double without_jerk = duration_of(parameterize_without_jerk(path, limits));
    ASSERT_LE(duration_of(parameterize(path, limits)), 1.08 * without_jerk);
  }
}

TEST(ReachabilityTiming, TimesAStraightLineByConstantAcceleration) {
  const JointLimits limits = arm_limits();
  JointVector a = JointVector::Zero(6), b(6);
  b << 1.5, -0.4, 0.3, 1.0, -0.2, 0.7;
  JointPath path;
  path.append(JointPiece::line(a, b, 0.5));
  const double speed = 1.0 / b.cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff();
  const double change = 10.0 * speed;
  const double exact = 1.0 / speed + speed / change;
  double before = 2.0 * exact;
  for (const int cells : {7, 71, 709}) {
    const double duration = duration_of(parameterize_without_jerk(path, limits, cells));
    EXPECT_GE(duration, exact * (1.0 - 1e-9));
    EXPECT_LT(duration, before);
    before = duration;
  }
  EXPECT_NEAR(before, exact, 1e-4 * exact);
}

TEST(ReachabilityTiming, StartsWhereTheCurveItselfStands) {
  // q' = q'' = 0 at both ends: nothing bounds the speed there.
  PathPoint from, to;
  from.q = from.q1 = from.q2 = from.q3 = to.q1 = to.q2 = to.q3 = JointVector::Zero(6);
  to.q = JointVector::LinSpaced(6, 0.1, 0.6);
  JointPath path;
  path.append(JointPiece::hermite(from, to, 1.0));
  const auto pieces = parameterize_without_jerk(path, arm_limits(), 200);
  const Certificate certificate = certify(pieces, without_jerk(arm_limits()));
  EXPECT_LE(worst_of(certificate.acceleration), 1.0 + 1e-9);
  JointPath line;
  line.append(JointPiece::line(from.q, to.q, 1.0));
  const double quickest = duration_of(parameterize_without_jerk(line, arm_limits(), 1000));
  EXPECT_NEAR(duration_of(pieces), quickest, 0.05 * quickest);
}

TEST(ReachabilityTiming, RefusesNumbersOfCellsThatAreNone) {
  JointPath path;
  path.append(JointPiece::line(JointVector::Zero(6), JointVector::Ones(6), 1.0));
  for (const int cells : {-1, 0, 10001}) {
    EXPECT_THROW((void)parameterize_without_jerk(path, arm_limits(), cells), MotionError);
  }
  EXPECT_THROW((void)parameterize_without_jerk(JointPath(), arm_limits()), MotionError);
}

}  // namespace
}  // namespace viapoint::testing
