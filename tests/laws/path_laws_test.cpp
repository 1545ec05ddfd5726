/// The laws of paths alone: cutting them, and following the tool's curve.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "path_subjects.hpp"

namespace viapoint::laws {
namespace {

double distance(const JointVector& a, const JointVector& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

class PathLaws : public ::testing::TestWithParam<Subject<PathCase>> {};

TEST_P(PathLaws, APartIsTheSameCurve) {
  const PathCase subject = GetParam().make();
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const JointPiece& piece : subject.path.pieces()) {
    for (int i = 0; i < 20; ++i) {
      double s0 = unit(random) * piece.length;
      double s1 = unit(random) * piece.length;
      if (s1 < s0) std::swap(s0, s1);
      if (s1 - s0 < 1e-3 * piece.length) continue;
      const JointPiece part = piece.part(s0, s1);
      EXPECT_NEAR(part.length, s1 - s0, 1e-14 * piece.length);
      EXPECT_EQ(part.kind, piece.kind);
      EXPECT_EQ(part.move, piece.move);
      const double s = unit(random) * part.length;
      const PathPoint here = part.at(s);
      const PathPoint there = piece.at(s0 + s);
      // Rounding of q spreads to the derivatives by the part's length.
      const double rounding = 1e-13 * (1.0 + piece.coefficients.cwiseAbs().maxCoeff());
      ASSERT_LE(distance(here.q, there.q), rounding);
      ASSERT_LE(distance(here.q1, there.q1), 100 * rounding / part.length);
      ASSERT_LE(distance(here.q2, there.q2), 1e4 * rounding / (part.length * part.length));
    }
  }
}

TEST_P(PathLaws, PiecesTileTheParameter) {
  const PathCase subject = GetParam().make();
  const JointPath& path = subject.path;
  double sum = 0.0;
  for (size_t i = 0; i < path.pieces().size(); ++i) {
    const JointPiece& piece = path.pieces()[i];
    ASSERT_GT(piece.length, 0.0);
    EXPECT_NEAR(path.start_of(i), sum, 1e-14 * path.length());
    EXPECT_EQ(path.piece_at(path.start_of(i)), i);
    EXPECT_EQ(path.piece_at(path.start_of(i) + 0.5 * piece.length), i);
    sum += piece.length;
  }
  EXPECT_NEAR(path.length(), sum, 1e-14 * sum);
  EXPECT_EQ(path.piece_at(path.length()), path.pieces().size() - 1);
}

INSTANTIATE_TEST_SUITE_P(Paths, PathLaws, ::testing::ValuesIn(all_paths()), SubjectName());

class ToolPathLaws : public ::testing::TestWithParam<Subject<ToolPathCase>> {};

TEST_P(ToolPathLaws, ToolStaysWithinTheProvenDeviationEverywhere) {
  const ToolPathCase subject = GetParam().make();
  EXPECT_LE(subject.insertion.position_deviation, subject.options.position_tolerance);
  const bool holds_rotation = subject.options.hold == Hold::kPose;
  if (holds_rotation) {
    EXPECT_LE(subject.insertion.angle_deviation, subject.options.angle_tolerance);
  }
  EXPECT_NEAR(subject.path.length(), subject.curve->length(), 1e-12 * subject.path.length());
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> along(0.0, subject.path.length());
  double reached = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double s = along(random);
    const Pose tool = subject.arm->forward().pose(subject.path.at(s).q);
    const CurvePoint wanted = subject.curve->at(std::min(s, subject.curve->length()));
    const double position = (tool.translation() - wanted.p).norm();
    reached = std::max(reached, position);
    ASSERT_LE(position, subject.insertion.position_deviation + 1e-12) << "at " << s;
    if (holds_rotation) {
      ASSERT_LE(rotation_distance(tool.linear(), wanted.rotation),
                subject.insertion.angle_deviation + 1e-9)
          << "at " << s;
    }
  }
  // A bound a hundred times too large would prove nothing about quality.
  EXPECT_GT(reached, 0.01 * subject.insertion.position_deviation);
}

TEST_P(ToolPathLaws, JointsStayWithinTheirLimitsEverywhere) {
  const ToolPathCase subject = GetParam().make();
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> along(0.0, subject.path.length());
  for (int i = 0; i < 20000; ++i) {
    const double s = along(random);
    ASSERT_TRUE(subject.arm->limits().contains(subject.path.at(s).q, 1e-9)) << "at " << s;
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, ToolPathLaws, ::testing::ValuesIn(tool_paths()), SubjectName());

}  // namespace
}  // namespace viapoint::laws
