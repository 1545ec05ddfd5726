/// The laws of everything that moves joints along one parameter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "axis_subjects.hpp"
#include "course.hpp"
#include "motion_subjects.hpp"
#include "path_subjects.hpp"

namespace viapoint::laws {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double magnitude(const JointVector& v) { return v.cwiseAbs().maxCoeff(); }
double distance(const JointVector& a, const JointVector& b) { return magnitude(a - b); }

/// Largest value of each derivative at samples of [from, to], both ends a little inside.
std::array<double, 4> sizes(const Course& course, double from, double to) {
  std::array<double, 4> largest{};
  for (int i = 0; i <= 20; ++i) {
    const Derivatives here = course.at(from + (to - from) * (1e-6 + (1 - 2e-6) * i / 20));
    for (size_t d = 0; d < 4; ++d) largest[d] = std::max(largest[d], magnitude(here[d]));
  }
  return largest;
}

/// Knots and both ends.
std::vector<double> borders(const Course& course) {
  std::vector<double> all = course.knots;
  all.insert(all.begin(), 0.0);
  all.push_back(course.length);
  return all;
}

class CourseLaws : public ::testing::TestWithParam<Subject<Course>> {};

TEST_P(CourseLaws, BeginsAndEndsWhereItShould) {
  const Course course = GetParam().make();
  ASSERT_GT(course.length, 0.0);
  EXPECT_LT(distance(course.at(0.0)[0], course.first), 1e-9);
  EXPECT_LT(distance(course.at(course.length)[0], course.last), 1e-9);
}

TEST_P(CourseLaws, DerivativesAreThoseOfTheValue) {
  const Course course = GetParam().make();
  const std::vector<double> border = borders(course);
  std::mt19937_64 random(5);
  double checked = 0.0;
  for (size_t piece = 0; piece + 1 < border.size(); ++piece) {
    const double width = border[piece + 1] - border[piece];
    const double step = 1e-4 * width;
    // The parameter itself is rounded: a difference is over 2 steps give or take that much.
    const double rounding = 8 * kEpsilon * course.length / step;
    if (rounding > 1e-3) continue;
    checked += width;
    const std::array<double, 4> scale = sizes(course, border[piece], border[piece + 1]);
    std::uniform_real_distribution<double> inside(border[piece] + 2 * step,
                                                  border[piece + 1] - 2 * step);
    for (int i = 0; i < 10; ++i) {
      const double p = inside(random);
      const Derivatives here = course.at(p);
      const Derivatives before = course.at(p - step);
      const Derivatives after = course.at(p + step);
      for (size_t d = 1; d < 4; ++d) {
        const JointVector difference = (after[d - 1] - before[d - 1]) / (2 * step);
        // Truncation and rounding of a central difference over 1e-4 of the piece.
        const double tolerance =
            (1e-5 + rounding) * scale[d] + 16 * kEpsilon * scale[d - 1] / step + 1e-300;
        ASSERT_LE(distance(here[d], difference), tolerance)
            << "derivative " << d << " at " << p << " in piece " << piece;
      }
    }
  }
  EXPECT_GT(checked, 0.99 * course.length) << "too little was checked";
}

TEST_P(CourseLaws, PiecesMeetInEveryContinuousDerivative) {
  const Course course = GetParam().make();
  const std::vector<double> border = borders(course);
  const double nudge = 4 * kEpsilon * course.length;
  const std::array<double, 4> overall = sizes(course, 0.0, course.length);
  for (size_t i = 1; i + 1 < border.size(); ++i) {
    const Derivatives before = course.at(border[i] - nudge);
    const Derivatives after = course.at(border[i]);
    const auto here = sizes(course, border[i - 1], border[i + 1]);
    for (size_t d = 0; d <= static_cast<size_t>(course.continuity); ++d) {
      // What the nudge itself changes, and rounding.
      const double tolerance =
          4 * nudge * (d < 3 ? here[d + 1] : 0.0) + 1e-9 * std::max(here[d], overall[d]) + 1e-300;
      ASSERT_LE(distance(before[d], after[d]), tolerance)
          << "derivative " << d << " at knot " << i << ", " << border[i];
    }
  }
}

TEST_P(CourseLaws, AKnotIsTheStartOfTheLaterPiece) {
  const Course course = GetParam().make();
  const std::vector<double> border = borders(course);
  for (size_t i = 1; i + 1 < border.size(); ++i) {
    const double width = border[i + 1] - border[i];
    const double nudge = std::max(1e-9 * width, 4 * kEpsilon * course.length);
    const Derivatives at_knot = course.at(border[i]);
    const Derivatives later = course.at(border[i] + nudge);
    const auto scale = sizes(course, border[i], border[i + 1]);
    // The third derivative tells the pieces apart.
    ASSERT_LE(distance(at_knot[3], later[3]), 1e3 * nudge / width * scale[3] + 1e-300)
        << "at knot " << i << ", " << border[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, CourseLaws, ::testing::ValuesIn(path_courses()), SubjectName());
INSTANTIATE_TEST_SUITE_P(Motions, CourseLaws, ::testing::ValuesIn(motion_courses()), SubjectName());
INSTANTIATE_TEST_SUITE_P(AxisLaws, CourseLaws, ::testing::ValuesIn(axis_courses()), SubjectName());

}  // namespace
}  // namespace viapoint::laws
