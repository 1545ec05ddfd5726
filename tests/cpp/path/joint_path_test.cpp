#include "viapoint/path/joint_path.hpp"

#include <gtest/gtest.h>

#include <random>

#include "problem_count.hpp"

namespace viapoint {
namespace {

JointVector random_vector(std::mt19937& random, int joints) {
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  JointVector v(joints);
  for (int i = 0; i < joints; ++i) {
    v[i] = uniform(random);
  }
  return v;
}

PathPoint random_point(std::mt19937& random, int joints) {
  return {random_vector(random, joints), random_vector(random, joints),
          random_vector(random, joints), JointVector::Zero(joints)};
}

double random_length(std::mt19937& random) {
  return std::exp(std::uniform_real_distribution<double>(-4.0, 2.0)(random));
}

double distance(const JointVector& a, const JointVector& b) {
  return (a - b).lpNorm<Eigen::Infinity>();
}

TEST(JointPiece, HermiteMeetsPositionSlopeAndCurvatureAtBothEnds) {
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const int joints = 1 + static_cast<int>(seed % kMaxJoints);
    const PathPoint a = random_point(random, joints);
    const PathPoint b = random_point(random, joints);
    const double length = random_length(random);
    const JointPiece piece = JointPiece::hermite(a, b, length);
    const PathPoint start = piece.at(0.0);
    const PathPoint end = piece.at(length);
    const double scale = 1.0 + length * length + 1.0 / (length * length);
    ASSERT_LT(distance(start.q, a.q), 1e-13);
    ASSERT_LT(distance(start.q1, a.q1), 1e-13);
    ASSERT_LT(distance(start.q2, a.q2), 1e-13 * scale);
    ASSERT_LT(distance(end.q, b.q), 1e-13 * scale);
    ASSERT_LT(distance(end.q1, b.q1), 1e-13 * scale);
    ASSERT_LT(distance(end.q2, b.q2), 1e-12 * scale);
  }
}

TEST(JointPiece, DerivativesAgreeWithDifferencesOfTheValue) {
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const JointPiece piece =
        JointPiece::hermite(random_point(random, 6), random_point(random, 6), 1.7);
    const double s = std::uniform_real_distribution<double>(0.01, 1.69)(random);
    constexpr double kStep = 1e-5;
    const PathPoint before = piece.at(s - kStep);
    const PathPoint here = piece.at(s);
    const PathPoint after = piece.at(s + kStep);
    ASSERT_LT(distance((after.q - before.q) / (2 * kStep), here.q1), 1e-7);
    ASSERT_LT(distance((after.q1 - before.q1) / (2 * kStep), here.q2), 1e-6);
    ASSERT_LT(distance((after.q2 - before.q2) / (2 * kStep), here.q3), 1e-5);
  }
}

TEST(JointPiece, LineHasConstantSlope) {
  const JointVector a = (JointVector(2) << 0.1, -0.4).finished();
  const JointVector b = (JointVector(2) << 0.7, 0.5).finished();
  const JointPiece piece = JointPiece::line(a, b, 0.3);
  for (const double s : {0.0, 0.1, 0.3}) {
    const PathPoint point = piece.at(s);
    EXPECT_LT(distance(point.q, a + (b - a) * (s / 0.3)), 1e-15);
    EXPECT_LT(distance(point.q1, (b - a) / 0.3), 1e-15);
    EXPECT_EQ(point.q2.norm(), 0.0);
    EXPECT_EQ(point.q3.norm(), 0.0);
  }
  EXPECT_EQ(piece.kind, PieceKind::kJointLine);
}

TEST(JointPiece, PartIsTheSameCurveAndKeepsWhatThePieceCarries) {
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    JointPiece piece = JointPiece::hermite(random_point(random, 6), random_point(random, 6), 1.3);
    piece.move = 7;
    piece.scale = 0.25;
    std::uniform_real_distribution<double> uniform(0.0, 1.3);
    double s0 = uniform(random);
    double s1 = uniform(random);
    if (s0 > s1) {
      std::swap(s0, s1);
    }
    if (s1 - s0 < 1e-3) {
      continue;
    }
    const JointPiece part = piece.part(s0, s1);
    ASSERT_EQ(part.move, 7);
    ASSERT_EQ(part.scale, 0.25);
    ASSERT_DOUBLE_EQ(part.length, s1 - s0);
    for (const double share : {0.0, 0.3, 1.0}) {
      const PathPoint of_part = part.at(share * part.length);
      const PathPoint of_whole = piece.at(s0 + share * part.length);
      ASSERT_LT(distance(of_part.q, of_whole.q), 1e-12);
      ASSERT_LT(distance(of_part.q1, of_whole.q1), 1e-9);
      ASSERT_LT(distance(of_part.q2, of_whole.q2), 1e-7);
    }
  }
}

TEST(JointPath, FindsThePieceThatHoldsAParameter) {
  const JointVector zero = JointVector::Zero(1);
  const JointVector one = JointVector::Ones(1);
  JointPath path;
  EXPECT_TRUE(path.empty());
  EXPECT_EQ(path.length(), 0.0);
  path.append(JointPiece::line(zero, one, 0.5));
  path.append(JointPiece::line(one, zero, 0.25));
  EXPECT_DOUBLE_EQ(path.length(), 0.75);
  EXPECT_DOUBLE_EQ(path.start_of(1), 0.5);
  EXPECT_EQ(path.piece_at(0.0), 0u);
  EXPECT_EQ(path.piece_at(0.49), 0u);
  EXPECT_EQ(path.piece_at(0.5), 1u);
  EXPECT_EQ(path.piece_at(0.75), 1u);
  EXPECT_EQ(path.piece_at(-1.0), 0u);
  EXPECT_EQ(path.piece_at(9.0), 1u);
  EXPECT_DOUBLE_EQ(path.at(0.25).q[0], 0.5);
  EXPECT_DOUBLE_EQ(path.at(0.625).q[0], 0.5);
  EXPECT_DOUBLE_EQ(path.at(0.75).q[0], 0.0);
  EXPECT_DOUBLE_EQ(path.at(9.0).q[0], 0.0);
}

}  // namespace
}  // namespace viapoint
