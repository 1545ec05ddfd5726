#include "viapoint/path/position_limits.hpp"

#include <gtest/gtest.h>

#include "path/teaching_arms.hpp"
#include "problem_count.hpp"

namespace viapoint {
namespace {

JointPiece random_piece(std::mt19937& random, int joints) {
  const JointLimits range = testing::symmetric_limits(JointVector::Constant(joints, 1.0));
  const auto vector = [&] { return testing::random_joints(random, range); };
  return JointPiece::hermite({vector(), 6.0 * vector(), 30.0 * vector(), {}},
                             {vector(), 6.0 * vector(), 30.0 * vector(), {}}, 0.7);
}

TEST(PiecePositionViolation, AgreesWithDenseSamples) {
  int breaches = 0;
  for (unsigned seed = 0; seed < problems(3000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const JointPiece piece = random_piece(random, 3);
    JointLimits limits = testing::symmetric_limits(JointVector::Constant(3, 1.3));
    limits.coupling.setZero(1, 3);
    limits.coupling << 1.0, -0.5, 0.25;
    limits.coupling_lower = CouplingVector::Constant(1, -1.4);
    limits.coupling_upper = CouplingVector::Constant(1, 1.4);
    double first = -1.0;
    constexpr int kSamples = 4000;
    for (int i = 0; i <= kSamples && first < 0.0; ++i) {
      const double s = piece.length * i / kSamples;
      if (!limits.contains(piece.at(s).q, kPositionLimitSlack)) first = s;
    }
    const auto found = piece_position_violation(piece, limits);
    if (first >= 0.0) {
      ASSERT_TRUE(found);
      ASSERT_LE(found->s, first + 1e-12);
      ++breaches;
    }
    if (!found) continue;
    ASSERT_TRUE((found->joint >= 0) != (found->coupling >= 0));
    // At the crossing the value is the limit, unless the piece starts beyond it.
    const JointVector q = piece.at(found->s).q;
    const double value = found->joint >= 0 ? q[found->joint] : limits.coupling.row(0).dot(q);
    if (found->s > 0.0) {
      ASSERT_NEAR(value, found->limit, 1e-8);
      // Everything before is inside.
      for (int i = 0; i < 50; ++i) {
        ASSERT_TRUE(limits.contains(piece.at(found->s * i / 50.0).q, 2 * kPositionLimitSlack));
      }
    }
    ASSERT_GT(std::abs(found->value), std::abs(found->limit));
    ASSERT_NEAR(farthest_value(piece, limits, *found), found->value, 1e-11);
  }
  EXPECT_GT(breaches, problems(500));
}

TEST(PiecePositionViolation, FindsAPeakBetweenSamples) {
  // Just above the limit over a millionth of the piece.
  const JointVector slope = JointVector::Constant(1, 1.0);
  const JointVector zero = JointVector::Zero(1);
  const JointPiece piece =
      JointPiece::hermite({zero, slope, zero, {}}, {zero, -slope, zero, {}}, 1.0);
  const double peak = piece.at(0.5).q[0];
  JointLimits limits = testing::no_position_limits(1);
  limits.position_max[0] = peak - 2e-9;
  const auto found = piece_position_violation(piece, limits);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->joint, 0);
  EXPECT_NEAR(found->s, 0.5, 1e-4);
  EXPECT_NEAR(found->value, peak, 1e-11);
  limits.position_max[0] = peak;
  EXPECT_FALSE(piece_position_violation(piece, limits));
}

TEST(PiecePositionViolation, PassesWhereThereAreNoLimits) {
  std::mt19937 random(1);
  EXPECT_FALSE(piece_position_violation(random_piece(random, 6), testing::no_position_limits(6)));
}

}  // namespace
}  // namespace viapoint
