#include "viapoint/profile/b_spline.hpp"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "profile/argument_check.hpp"

namespace viapoint {
namespace {

constexpr int kMaxSplineDegree = 5;
using Local = std::array<double, kMaxSplineDegree + 1>;

void require_degree(int degree) {
  if (degree >= 1 && degree <= kMaxSplineDegree) return;
  refuse("the degree is " + std::to_string(degree) + "; it must be 1 to " +
             std::to_string(kMaxSplineDegree),
         degree, degree < 1 ? 1.0 : kMaxSplineDegree);
}

void require_interval(double t0, double t1) {
  require_finite(t0, "t0");
  require_finite(t1, "t1");
  if (t0 < t1) return;
  refuse("the law ends at " + written(t1) + " s, not after it begins at " + written(t0) + " s",
         t1 - t0, 0.0);
}

void require_points(size_t points, int degree) {
  if (points > static_cast<size_t>(degree)) return;
  refuse("a spline of degree " + std::to_string(degree) + " needs at least " +
             std::to_string(degree + 1) + " control points, but " + std::to_string(points) +
             " were given",
         static_cast<double>(points), degree + 1.0, {"give a smaller degree", "add points"});
}

void require_knots(std::span<const double> knots, size_t points, int degree) {
  const size_t wanted = points + static_cast<size_t>(degree) + 1;
  if (knots.size() != wanted) {
    refuse(std::to_string(points) + " control points of degree " + std::to_string(degree) +
               " need " + std::to_string(wanted) + " knots, but " + std::to_string(knots.size()) +
               " were given",
           static_cast<double>(knots.size()), static_cast<double>(wanted));
  }
  require_finite(knots, "knots");
  for (size_t i = 1; i < knots.size(); ++i) {
    if (knots[i] >= knots[i - 1]) continue;
    refuse("knots[" + std::to_string(i) + "] is " + written(knots[i]) +
               " s, less than the one before, " + written(knots[i - 1]) + " s",
           knots[i], knots[i - 1]);
  }
  const auto p = static_cast<size_t>(degree);
  for (size_t i = p + 1; i + p < points; ++i) {  // p + 1 equal knots inside tear the law apart
    if (knots[i + p] > knots[i]) continue;
    refuse("the knot " + written(knots[i]) + " s comes more than " + std::to_string(degree) +
               " times inside; the law would jump there",
           knots[i], degree, {"repeat a knot at most as often as the degree"});
  }
}

/// The spline of `degree` at x in span j from d, its control points j − degree to j (de Boor).
double de_boor(Local d, std::span<const double> knots, size_t j, size_t degree, double x) {
  for (size_t r = 1; r <= degree; ++r) {
    for (size_t m = degree; m >= r; --m) {
      const size_t i = j - degree + m;
      const double share = (x - knots[i]) / (knots[i + degree - r + 1] - knots[i]);
      d[m] = (1.0 - share) * d[m - 1] + share * d[m];
    }
  }
  return d[degree];
}

/// Coefficients of (t − knots[j])^m in span j.
Polynomial::Coefficients span_coefficients(std::span<const double> points,
                                           std::span<const double> knots, size_t j, size_t degree) {
  Local d{};
  for (size_t m = 0; m <= degree; ++m) d[m] = points[j - degree + m];
  Polynomial::Coefficients c{};
  double factorial = 1.0;
  for (size_t order = 0; order <= degree; ++order) {
    const size_t left = degree - order;
    c[order] = de_boor(d, knots, j, left, knots[j]) / factorial;
    for (size_t m = 0; m < left; ++m) {  // control points of the derivative
      const size_t i = j - left + m + 1;
      d[m] = static_cast<double>(left) * (d[m + 1] - d[m]) / (knots[i + left] - knots[i]);
    }
    factorial *= static_cast<double>(order + 1);
  }
  return c;
}

/// The values of the degree + 1 basis functions that are not 0 in span j, or of a derivative.
Local basis(std::span<const double> knots, size_t j, size_t degree, double x, int derivative) {
  Local values{};
  for (size_t n = 0; n <= degree; ++n) {
    Local d{};
    d[n] = 1.0;
    for (int order = 0; order < derivative; ++order) {
      const size_t left = degree - static_cast<size_t>(order);
      for (size_t m = 0; m < left; ++m) {
        const size_t i = j - left + m + 1;
        d[m] = static_cast<double>(left) * (d[m + 1] - d[m]) / (knots[i + left] - knots[i]);
      }
    }
    values[n] = de_boor(d, knots, j, degree - static_cast<size_t>(derivative), x);
  }
  return values;
}

}  // namespace

AxisLaw bezier(std::span<const double> points, double t0, double t1) {
  constexpr size_t kMost = Polynomial::kMaxDegree + 1;
  if (points.size() < 2 || points.size() > kMost) {
    refuse("a Bézier law takes 2 to " + std::to_string(kMost) + " control points, but " +
               std::to_string(points.size()) + " were given",
           static_cast<double>(points.size()), static_cast<double>(points.size() < 2 ? 2 : kMost),
           {"use a B-spline for more points"});
  }
  require_finite(points, "points");
  require_interval(t0, t1);
  // c_m = (n choose m) Δ^m P_0 / T^m
  std::vector<double> difference(points.begin(), points.end());
  Polynomial law{t0, t1, {}};
  double factor = 1.0;
  const size_t degree = points.size() - 1;
  for (size_t m = 0; m <= degree; ++m) {
    law.c[m] = factor * difference[0];
    for (size_t i = 0; i + m < degree; ++i) difference[i] = difference[i + 1] - difference[i];
    factor *= static_cast<double>(degree - m) / static_cast<double>(m + 1) / (t1 - t0);
  }
  require_arrival(law, points.back());
  return AxisLaw({law});
}

AxisLaw b_spline(std::span<const double> points, std::span<const double> knots, int degree) {
  require_degree(degree);
  require_points(points.size(), degree);
  require_finite(points, "points");
  require_knots(knots, points.size(), degree);
  std::vector<Polynomial> parts;
  const auto p = static_cast<size_t>(degree);
  for (size_t j = p; j < points.size(); ++j) {
    if (!(knots[j + 1] > knots[j])) continue;
    parts.push_back({knots[j], knots[j + 1], span_coefficients(points, knots, j, p)});
    Local d{};
    for (size_t m = 0; m <= p; ++m) d[m] = points[j - p + m];
    require_arrival(parts.back(), de_boor(d, knots, j, p, knots[j + 1]));
  }
  return AxisLaw(std::move(parts));
}

std::vector<double> clamped_knots(size_t points, int degree, double t0, double t1) {
  require_degree(degree);
  require_points(points, degree);
  require_interval(t0, t1);
  const auto p = static_cast<size_t>(degree);
  const size_t spans = points - p;
  std::vector<double> knots(p, t0);
  for (size_t i = 0; i <= spans; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(spans);
    knots.push_back(i == spans ? t1 : t0 + share * (t1 - t0));
  }
  knots.insert(knots.end(), p, t1);
  return knots;
}

InterpolatingSpline spline_through(std::span<const double> points,
                                   std::span<const double> durations, int degree,
                                   const AxisState& first, const AxisState& last) {
  if (degree != 3 && degree != 5) {
    refuse("the degree is " + std::to_string(degree) +
               "; through points it must be 3 or 5, so that both ends have equally many conditions",
           degree, degree < 5 ? 3.0 : 5.0);
  }
  require_segments(points.size(), durations.size(), "durations");
  require_finite(points, "points");
  require_positive(durations, "durations");
  require_finite(std::array{first.qd, first.qdd, last.qd, last.qdd}, "end condition");
  const auto p = static_cast<size_t>(degree);
  InterpolatingSpline spline;
  spline.knots.assign(p + 1, 0.0);
  for (const double duration : durations) spline.knots.push_back(spline.knots.back() + duration);
  spline.knots.insert(spline.knots.end(), p, spline.knots.back());
  require_finite(spline.knots, "times");

  const size_t size = points.size() + p - 1;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd values(static_cast<Eigen::Index>(size));
  Eigen::Index row = 0;
  const auto demand = [&](size_t j, double x, int derivative, double value) {
    const Local b = basis(spline.knots, j, p, x, derivative);
    // Rows of derivatives shrink with the unit of time: bring all to the size of one.
    double largest = 0.0;
    for (size_t n = 0; n <= p; ++n) largest = std::max(largest, std::abs(b[n]));
    for (size_t n = 0; n <= p; ++n) {
      entries.emplace_back(row, static_cast<Eigen::Index>(j - p + n), b[n] / largest);
    }
    values[row++] = value / largest;
  };
  const size_t last_span = size - 1;
  const double end = spline.knots.back();
  const std::array ends{std::pair{first.qd, last.qd}, std::pair{first.qdd, last.qdd}};
  const int end_orders = (degree - 1) / 2;
  for (int order = end_orders; order >= 1; --order) {
    demand(p, 0.0, order, ends[static_cast<size_t>(order - 1)].first);
  }
  for (size_t i = 0; i < points.size(); ++i) {
    const bool at_end = i + 1 == points.size();
    demand(at_end ? last_span : p + i, at_end ? end : spline.knots[p + i], 0, points[i]);
  }
  for (int order = 1; order <= end_orders; ++order) {
    demand(last_span, end, order, ends[static_cast<size_t>(order - 1)].second);
  }
  const auto n = static_cast<Eigen::Index>(size);
  Eigen::SparseMatrix<double> rows(n, n);
  rows.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(rows);
  const Eigen::VectorXd solution = solver.solve(values);
  // Schoenberg and Whitney's condition holds for these knots; what is left is overflow.
  if (solver.info() != Eigen::Success || !solution.allFinite()) {
    refuse("durations from " + written(*std::ranges::min_element(durations)) + " to " +
               written(*std::ranges::max_element(durations)) +
               " s are too far apart for one spline",
           *std::ranges::min_element(durations), *std::ranges::max_element(durations));
  }
  spline.control_points.assign(solution.begin(), solution.end());
  return spline;
}

}  // namespace viapoint
