#include "viapoint/path/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "problem_count.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

JointVector random_point(std::mt19937& random, int size) {
  std::normal_distribution<double> normal;
  JointVector point(size);
  for (double& value : point) value = normal(random);
  return point;
}

struct Data {
  std::vector<JointVector> points;
  std::vector<double> at;
};

Data random_data(unsigned seed, size_t count, int size, double spread) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> decades(-spread, 0.0);
  Data data{{random_point(random, size)}, {0.0}};
  while (data.points.size() < count) {
    data.points.push_back(random_point(random, size));
    data.at.push_back(data.at.back() + std::pow(10.0, decades(random)));
  }
  return data;
}

/// The r-th derivative of a quintic piece by s, at u.
JointVector derivative(const JointPiece& piece, int r, double u) {
  JointVector sum = JointVector::Zero(piece.joints());
  for (int k = r; k < 6; ++k) {
    double factor = std::pow(u, k - r);
    for (int i = 0; i < r; ++i) factor *= k - i;
    sum += factor * piece.coefficients.row(k).transpose();
  }
  return sum / std::pow(piece.length, r);
}

class NaturalSpline : public ::testing::TestWithParam<int> {};

TEST_P(NaturalSpline, PassesItsPointsAndIsAsSmoothAsItsDegreeAllows) {
  const int degree = GetParam();
  for (unsigned seed = 0; seed < problems(500U); ++seed) {
    SCOPED_TRACE(seed);
    const Data data = random_data(seed, 2 + seed % 12, 1 + static_cast<int>(seed % 7), 1.5);
    const JointPath path = quintic_chain(natural_spline(data.points, data.at, degree), data.at);
    const auto& pieces = path.pieces();
    ASSERT_EQ(pieces.size() + 1, data.points.size());
    for (size_t k = 0; k < pieces.size(); ++k) {
      ASSERT_LT((pieces[k].at(0.0).q - data.points[k]).norm(), 1e-12);
      ASSERT_LT((pieces[k].at(pieces[k].length).q - data.points[k + 1]).norm(), 1e-11);
      // A cubic has no more than a third derivative.
      for (int r = degree + 1; r <= 5; ++r) {
        ASSERT_LT(derivative(pieces[k], r, 0.5).norm() * std::pow(pieces[k].length, r),
                  1e-9 * (1.0 + pieces[k].coefficients.norm()));
      }
      if (k == 0) continue;
      for (int r = 1; r < degree; ++r) {
        const JointVector before = derivative(pieces[k - 1], r, 1.0);
        const JointVector after = derivative(pieces[k], r, 0.0);
        // Rounding of the values grows with each derivative, by the shorter length.
        const double h = std::min(pieces[k - 1].length, pieces[k].length);
        ASSERT_LT((before - after).norm() * std::pow(h, r),
                  1e-9 * (1.0 + pieces[k - 1].coefficients.norm() + pieces[k].coefficients.norm()))
            << "derivative " << r << " at knot " << k;
      }
    }
    const int m = (degree - 1) / 2;
    for (int r = m + 1; r <= 2 * m; ++r) {
      const double size = pieces.front().coefficients.norm() + pieces.back().coefficients.norm();
      EXPECT_LT(derivative(pieces.front(), r, 0.0).norm() * std::pow(pieces.front().length, r),
                1e-9 * (1.0 + size));
      EXPECT_LT(derivative(pieces.back(), r, 1.0).norm() * std::pow(pieces.back().length, r),
                1e-9 * (1.0 + size));
    }
  }
}

TEST_P(NaturalSpline, ReproducesStraightLines) {
  const std::vector<double> at = {0.0, 0.3, 1.0, 1.1, 4.0};
  std::vector<JointVector> points;
  JointVector direction(3);
  direction << 1.0, -2.0, 0.5;
  for (const double s : at) points.emplace_back(s * direction);
  const std::vector<PathPoint> knots = natural_spline(points, at, GetParam());
  for (const PathPoint& knot : knots) {
    // Rounding, magnified by spans that differ 29 times.
    EXPECT_LT((knot.q1 - direction).norm(), 1e-10);
    EXPECT_LT(knot.q2.norm(), 1e-9);
  }
}

TEST_P(NaturalSpline, IsStraightThroughTwoPoints) {
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    const Data data = random_data(seed, 2, 3, 3.0);
    const JointVector slope = (data.points[1] - data.points[0]) / data.at[1];
    for (const PathPoint& knot : natural_spline(data.points, data.at, GetParam())) {
      ASSERT_LT((knot.q1 - slope).norm(), 1e-12 * slope.norm());
      ASSERT_LT(knot.q2.norm() * data.at[1], 1e-11 * slope.norm());
    }
  }
}

TEST_P(NaturalSpline, BendsLessThanAnyOtherFunctionThroughThePoints) {
  // Adding any bump that vanishes at the points can only make ∫‖f^(m+1)‖² larger.
  const int degree = GetParam();
  const int m = (degree - 1) / 2;
  const Data data = random_data(7, 6, 1, 0.5);
  const JointPath path = quintic_chain(natural_spline(data.points, data.at, degree), data.at);
  const auto bump = [&](double s) {
    double product = 1.0;
    for (const double place : data.at) product *= s - place;
    return product;
  };
  constexpr int kSteps = 40000;
  const double h = path.length() / kSteps;
  const auto energy = [&](double amount) {
    const auto f = [&](double s) { return path.at(s).q[0] + amount * bump(s); };
    double sum = 0.0;
    for (int i = 3; i + 3 < kSteps; ++i) {
      const double s = i * h;
      const double d = m == 1 ? (f(s + h) - 2.0 * f(s) + f(s - h)) / (h * h)
                              : (f(s + 2 * h) - 2.0 * f(s + h) + 2.0 * f(s - h) - f(s - 2 * h)) /
                                    (2.0 * h * h * h);
      sum += h * d * d;
    }
    return sum;
  };
  const double least = energy(0.0);
  for (const double amount : {-0.1, -0.01, 0.01, 0.1}) EXPECT_GT(energy(amount), least) << amount;
}

TEST_P(NaturalSpline, PutsUpWithSpansThatDifferByDecades) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    const Data data = random_data(seed, 30, 2, 4.0);
    const auto knots = natural_spline(data.points, data.at, GetParam());
    const JointPath path = quintic_chain(knots, data.at);
    for (size_t k = 0; k < data.points.size(); ++k) {
      const JointVector miss = path.at(data.at[k]).q - data.points[k];
      ASSERT_LT(miss.norm(), 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, NaturalSpline, ::testing::Values(3, 5));

/// Bernstein's polynomial, straight from its definition.
JointVector bezier_at(const std::vector<JointVector>& control, double u) {
  const auto n = static_cast<int>(control.size()) - 1;
  JointVector sum = JointVector::Zero(control[0].size());
  double binomial = 1.0;
  for (int i = 0; i <= n; ++i) {
    sum += binomial * std::pow(u, i) * std::pow(1.0 - u, n - i) * control[static_cast<size_t>(i)];
    binomial *= static_cast<double>(n - i) / (i + 1);
  }
  return sum;
}

TEST(BSplinePath, IsTheBezierCurveWithOnePiece) {
  for (int degree = 1; degree <= 5; ++degree) {
    std::mt19937 random(static_cast<unsigned>(degree));
    std::vector<JointVector> control;
    for (int i = 0; i <= degree; ++i) control.push_back(random_point(random, 3));
    const JointPath path = b_spline_path(control, degree, 2.0);
    ASSERT_EQ(path.pieces().size(), 1u);
    for (int i = 0; i <= 20; ++i) {
      EXPECT_LT((path.at(0.1 * i).q - bezier_at(control, 0.05 * i)).norm(), 1e-13);
    }
  }
}

/// The basis function by its recursion (Cox 1972; de Boor 1972).
double basis(const std::vector<double>& knots, size_t i, size_t degree, double x) {
  if (degree == 0) return x >= knots[i] && x < knots[i + 1] ? 1.0 : 0.0;
  double sum = 0.0;
  const double left = knots[i + degree] - knots[i];
  const double right = knots[i + degree + 1] - knots[i + 1];
  if (left > 0.0) sum += (x - knots[i]) / left * basis(knots, i, degree - 1, x);
  if (right > 0.0) {
    sum += (knots[i + degree + 1] - x) / right * basis(knots, i + 1, degree - 1, x);
  }
  return sum;
}

TEST(BSplinePath, IsTheSumOfItsBasisFunctions) {
  for (int degree = 3; degree <= 5; ++degree) {
    std::mt19937 random(static_cast<unsigned>(degree));
    std::vector<JointVector> control;
    for (int i = 0; i < 9; ++i) control.push_back(random_point(random, 2));
    const JointPath path = b_spline_path(control, degree, 3.0);
    const int spans = 9 - degree;
    std::vector<double> knots(static_cast<size_t>(degree), 0.0);
    for (int i = 0; i <= spans; ++i) knots.push_back(3.0 * i / spans);
    knots.insert(knots.end(), static_cast<size_t>(degree), 3.0);
    for (int i = 0; i < 60; ++i) {
      const double x = 3.0 * i / 60;
      JointVector sum = JointVector::Zero(2);
      for (size_t k = 0; k < control.size(); ++k) {
        sum += basis(knots, k, static_cast<size_t>(degree), x) * control[k];
      }
      ASSERT_LT((path.at(x).q - sum).norm(), 1e-12) << "degree " << degree << " at " << x;
    }
    EXPECT_LT((path.at(3.0).q - control.back()).norm(), 1e-13);
    for (size_t k = 1; k < path.pieces().size(); ++k) {
      const PathPoint before = path.pieces()[k - 1].at(path.pieces()[k - 1].length);
      const PathPoint after = path.pieces()[k].at(0.0);
      EXPECT_LT((before.q1 - after.q1).norm(), 1e-12);
      EXPECT_LT((before.q2 - after.q2).norm(), 1e-11);
    }
  }
}

TEST(BSplinePath, ReproducesLinesOverGrevillesAbscissae) {
  for (int degree = 3; degree <= 5; ++degree) {
    const std::vector<double> places = greville_abscissae(8, degree, 2.5);
    std::vector<JointVector> control;
    for (const double place : places) control.push_back(JointVector::Constant(1, 4.0 * place));
    const JointPath path = b_spline_path(control, degree, 2.5);
    for (int i = 0; i <= 25; ++i) EXPECT_NEAR(path.at(0.1 * i).q[0], 0.4 * i, 1e-12);
  }
}

TEST(SlowestPlace, FindsACusp) {
  // Inner control points moved past one another: first a cusp, then a loop.
  const auto curve = [](double reach) {
    std::vector<JointVector> control(4, JointVector::Zero(2));
    control[1] << reach, 1.0;
    control[2] << 1.0 - reach, 1.0;
    control[3] << 1.0, 0.0;
    return b_spline_path(control, 3, 1.0);
  };
  EXPECT_GT(slowest_place(curve(0.5), 1e-3).share, 0.9e-3);
  const SlowestPlace cusp = slowest_place(curve(1.0), 1e-3);
  EXPECT_LT(cusp.share, 1e-3);
  EXPECT_NEAR(cusp.s, 0.5, 1e-2);
  EXPECT_GT(slowest_place(curve(2.0), 1e-3).share, 0.9e-3);
  std::vector<JointVector> still(4, JointVector::Constant(2, 0.3));
  EXPECT_EQ(slowest_place(b_spline_path(still, 3, 1.0), 1e-3).share, 0.0);
}

TEST(Splines, RefuseArgumentsThatMakeNoSense) {
  const JointVector zero = JointVector::Zero(2);
  const JointVector one = JointVector::Ones(2);
  const auto refused = [](const std::vector<JointVector>& points, const std::vector<double>& at,
                          int degree) {
    try {
      (void)natural_spline(points, at, degree);
    } catch (const MotionError& error) {
      return error.code() == ErrorCode::kBadArgument;
    }
    return false;
  };
  EXPECT_TRUE(refused({zero, one}, {0.0, 1.0}, 4));
  EXPECT_TRUE(refused({zero}, {0.0}, 3));
  EXPECT_TRUE(refused({zero, one}, {0.0}, 3));
  EXPECT_TRUE(refused({zero, one}, {0.0, 0.0}, 3));
  EXPECT_TRUE(refused({zero, JointVector::Zero(3)}, {0.0, 1.0}, 3));
  EXPECT_TRUE(refused({zero, JointVector::Constant(2, std::nan(""))}, {0.0, 1.0}, 3));
  EXPECT_FALSE(refused({zero, one}, {0.0, 1.0}, 3));
  const std::vector<JointVector> four = {zero, one, zero, one};
  EXPECT_THROW((void)b_spline_path(four, 4, 1.0), MotionError);
  EXPECT_THROW((void)b_spline_path(four, 2, 1.0), MotionError);
  EXPECT_THROW((void)b_spline_path(four, 3, 0.0), MotionError);
  EXPECT_NO_THROW((void)b_spline_path(four, 3, 1.0));
}

}  // namespace
}  // namespace viapoint
