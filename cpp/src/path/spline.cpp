#include "viapoint/path/spline.hpp"

#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "path/chain_bounds.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

constexpr int kMostDegree = 5;
constexpr int kDeepest = 30;

[[noreturn]] void refuse(std::string message) {
  throw MotionError(ErrorCode::kBadArgument, std::move(message));
}

/// Polynomial of degree 2m + 1 on [0, 1] from f, f', … f^(m) at 0 and then at 1: the rows give its
/// derivatives m + 1 … 2m, at 0 and at 1.
struct HigherDerivatives {
  Eigen::MatrixXd at_start, at_end;  ///< (m, 2m + 2)

  explicit HigherDerivatives(int m) {
    const int size = 2 * m + 2;
    Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(size, size);
    for (int r = 0; r <= m; ++r) {
      conditions(r, r) = falling(r, r);
      for (int k = r; k < size; ++k) conditions(m + 1 + r, k) = falling(k, r);
    }
    const Eigen::MatrixXd coefficients = conditions.inverse();
    Eigen::MatrixXd start = Eigen::MatrixXd::Zero(m, size);
    Eigen::MatrixXd end = Eigen::MatrixXd::Zero(m, size);
    for (int row = 0; row < m; ++row) {
      const int r = m + 1 + row;
      start(row, r) = falling(r, r);
      for (int k = r; k < size; ++k) end(row, k) = falling(k, r);
    }
    at_start = start * coefficients;
    at_end = end * coefficients;
  }

 private:
  /// k (k − 1) … (k − r + 1): the factor of the r-th derivative of u^k at 1.
  static double falling(int k, int r) {
    double product = 1.0;
    for (int i = 0; i < r; ++i) product *= k - i;
    return product;
  }
};

void check_points(std::span<const JointVector> points, std::span<const double> at, int degree) {
  if (degree != 3 && degree != 5) {
    refuse("a spline through points has degree 3 or 5, not " + std::to_string(degree));
  }
  if (points.size() < 2 || at.size() != points.size()) {
    refuse(std::to_string(points.size()) + " points at " + std::to_string(at.size()) +
           " places; a spline needs at least two points, each at one place");
  }
  for (size_t i = 0; i < points.size(); ++i) {
    const std::string name = "point " + std::to_string(i);
    if (points[i].size() != points[0].size() || points[i].size() == 0) {
      refuse(name + " has another size than point 0");
    }
    if (!points[i].allFinite() || !std::isfinite(at[i])) refuse(name + " is not finite");
    if (i > 0 && !(at[i] > at[i - 1])) refuse(name + " is not placed after the one before");
  }
}

/// The unknowns f', … f^(m) of every knot follow from the continuity of the derivatives m + 1 … 2m
/// at the inner knots, and from these being zero at both ends.
class NaturalSystem {
 public:
  NaturalSystem(std::span<const JointVector> points, std::span<const double> at, int degree)
      : points_(points), at_(at), m_((degree - 1) / 2), higher_(m_) {}

  /// Row k (m + j): derivative j + 1 at knot k.
  Eigen::MatrixXd solve() {
    const auto knots = static_cast<Eigen::Index>(points_.size());
    const Eigen::Index size = knots * m_;
    right_ = Eigen::MatrixXd::Zero(size, points_[0].size());
    for (Eigen::Index k = 0; k < knots; ++k) {
      // Rows count in the shorter span beside the knot, so that spans may differ by decades.
      const double left = k > 0 ? span_length(k - 1) : span_length(k);
      const double right = k + 1 < knots ? span_length(k) : left;
      unit_ = std::min(left, right);
      if (k > 0) add_span(k, k - 1, higher_.at_end, 1.0);
      if (k + 1 < knots) add_span(k, k, higher_.at_start, -1.0);
    }
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success) refuse("the points are placed too unevenly for a spline");
    const Eigen::MatrixXd solution = solver.solve(right_);
    if (!solution.allFinite()) refuse("the points are placed too unevenly for a spline");
    return solution;
  }

  double span_length(Eigen::Index span) const {
    const auto k = static_cast<size_t>(span);
    return at_[k + 1] - at_[k];
  }

 private:
  /// Adds ±(derivatives m + 1 … 2m of `span` at one of its ends) to the rows of `knot`.
  void add_span(Eigen::Index knot, Eigen::Index span, const Eigen::MatrixXd& derivatives,
                double sign) {
    const double h = span_length(span);
    for (int row = 0; row < m_; ++row) {
      const double scale = sign * std::pow(unit_ / h, m_ + 1 + row);
      const Eigen::Index equation = knot * m_ + row;
      for (int end = 0; end < 2; ++end) {
        const int first = end * (m_ + 1);
        const JointVector& value = points_[static_cast<size_t>(span + end)];
        right_.row(equation) -= scale * derivatives(row, first) * value.transpose();
        for (int j = 1; j <= m_; ++j) {
          entries_.emplace_back(equation, (span + end) * m_ + j - 1,
                                scale * derivatives(row, first + j) * std::pow(h, j));
        }
      }
    }
  }

  std::span<const JointVector> points_;
  std::span<const double> at_;
  int m_;
  HigherDerivatives higher_;
  double unit_ = 1.0;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::MatrixXd right_;
};

/// f'' at the start of a cubic from its ends.
JointVector cubic_bend(const PathPoint& from, const PathPoint& to, double h) {
  return (6.0 * (to.q - from.q) / h - 4.0 * from.q1 - 2.0 * to.q1) / h;
}

std::vector<double> clamped_uniform_knots(size_t control, int degree, double length) {
  const size_t spans = control - static_cast<size_t>(degree);
  std::vector<double> knots(static_cast<size_t>(degree), 0.0);
  for (size_t i = 0; i <= spans; ++i) {
    knots.push_back(length * static_cast<double>(i) / static_cast<double>(spans));
  }
  knots.insert(knots.end(), static_cast<size_t>(degree), length);
  return knots;
}

/// De Boor's algorithm in the span [knots[j], knots[j + 1]], whose control points are
/// control[j − degree] … control[j].
JointVector de_boor(std::vector<JointVector> local, std::span<const double> knots, size_t j,
                    size_t degree, double x) {
  for (size_t r = 1; r <= degree; ++r) {
    for (size_t m = degree; m >= r; --m) {
      const size_t i = j - degree + m;
      const double share = (x - knots[i]) / (knots[i + degree - r + 1] - knots[i]);
      local[m] = (1.0 - share) * local[m - 1] + share * local[m];
    }
  }
  return local[degree];
}

/// Value and two derivatives at x of the span j.
PathPoint b_spline_point(std::span<const JointVector> control, std::span<const double> knots,
                         size_t j, size_t degree, double x) {
  std::vector<JointVector> local(control.begin() + static_cast<std::ptrdiff_t>(j - degree),
                                 control.begin() + static_cast<std::ptrdiff_t>(j + 1));
  std::array<JointVector, 3> derivatives;
  for (size_t order = 0; order < derivatives.size(); ++order) {
    if (order > degree) {
      derivatives[order] = JointVector::Zero(control[0].size());
      continue;
    }
    const size_t left = degree - order;
    derivatives[order] = de_boor(local, knots, j, left, x);
    for (size_t m = 0; m < left; ++m) {  // control points of the next derivative
      const size_t i = j - left + m + 1;
      local[m] =
          static_cast<double>(left) * (local[m + 1] - local[m]) / (knots[i + left] - knots[i]);
    }
    local.resize(std::max<size_t>(left, 1));
  }
  return {derivatives[0], derivatives[1], derivatives[2], JointVector::Zero(control[0].size())};
}

}  // namespace

std::vector<PathPoint> natural_spline(std::span<const JointVector> points,
                                      std::span<const double> at, int degree) {
  check_points(points, at, degree);
  // Through two points every parabola has f''' = 0: the straight line is the least of them.
  const int used = points.size() == 2 ? 3 : degree;
  NaturalSystem system(points, at, used);
  const Eigen::MatrixXd solution = system.solve();
  const int m = (used - 1) / 2;
  const JointVector zero = JointVector::Zero(points[0].size());
  std::vector<PathPoint> knots;
  knots.reserve(points.size());
  for (size_t k = 0; k < points.size(); ++k) {
    const Eigen::Index row = static_cast<Eigen::Index>(k) * m;
    PathPoint knot{points[k], solution.row(row).transpose(), zero, zero};
    if (m == 2) knot.q2 = solution.row(row + 1).transpose();
    knots.push_back(std::move(knot));
  }
  if (m == 1) {
    for (size_t k = 0; k + 1 < knots.size(); ++k) {
      knots[k].q2 = cubic_bend(knots[k], knots[k + 1], at[k + 1] - at[k]);
    }
    knots.front().q2 = zero;
    knots.back().q2 = zero;
  }
  return knots;
}

JointPath quintic_chain(std::span<const PathPoint> knots, std::span<const double> at) {
  JointPath path;
  for (size_t k = 0; k + 1 < knots.size(); ++k) {
    path.append(JointPiece::hermite(knots[k], knots[k + 1], at[k + 1] - at[k]));
  }
  return path;
}

JointPath b_spline_path(std::span<const JointVector> control, int degree, double length) {
  const auto wanted = static_cast<size_t>(std::max(degree, 0)) + 1;
  if (degree < 1 || degree > kMostDegree || control.size() < wanted ||
      (degree < 3 && control.size() != wanted)) {
    refuse("a B-spline of degree " + std::to_string(degree) + " by " +
           std::to_string(control.size()) +
           " control points; the degree must be 3 to 5, with at least one point more than that "
           "(one piece alone may have any degree up to 5)");
  }
  if (!(length > 0.0) || !std::isfinite(length)) refuse("a B-spline needs a length above zero");
  for (const JointVector& point : control) {
    if (point.size() != control[0].size() || !point.allFinite()) {
      refuse("control points must be finite and of one size");
    }
  }
  const std::vector<double> knots = clamped_uniform_knots(control.size(), degree, length);
  const auto p = static_cast<size_t>(degree);
  JointPath path;
  for (size_t j = p; j < control.size(); ++j) {
    const PathPoint from = b_spline_point(control, knots, j, p, knots[j]);
    const PathPoint to = b_spline_point(control, knots, j, p, knots[j + 1]);
    path.append(JointPiece::hermite(from, to, knots[j + 1] - knots[j]));
  }
  return path;
}

std::vector<double> greville_abscissae(size_t control, int degree, double length) {
  const std::vector<double> knots = clamped_uniform_knots(control, degree, length);
  std::vector<double> places(control);
  for (size_t i = 0; i < control; ++i) {
    double sum = 0.0;
    for (int k = 1; k <= degree; ++k) sum += knots[i + static_cast<size_t>(k)];
    places[i] = sum / degree;
  }
  places.back() = length;
  return places;
}

SlowestPlace slowest_place(const JointPath& path, double enough) {
  double travelled = 0.0;
  for (const JointPiece& piece : path.pieces()) {
    constexpr int kChords = 8;
    for (int i = 0; i < kChords; ++i) {
      travelled +=
          (piece.at(piece.length * (i + 1) / kChords).q - piece.at(piece.length * i / kChords).q)
              .norm();
    }
  }
  if (!(travelled > 0.0)) return {};
  const double mean = travelled / path.length();

  struct Interval {
    double middle, half;
    int depth;
  };
  SlowestPlace slowest{enough, 0.0};
  for (size_t k = 0; k < path.pieces().size(); ++k) {
    const JointPiece& piece = path.pieces()[k];
    std::vector<Interval> open = {{0.5 * piece.length, 0.5 * piece.length, 0}};
    while (!open.empty()) {
      const auto [middle, half, depth] = open.back();
      open.pop_back();
      const PathPoint at = piece.at(middle);
      const double bend = joint_suprema(piece, at, middle, half).q2.norm();
      const double reached = at.q1.norm() / mean;
      const double bound = std::max(0.0, reached - half * bend / mean);
      if (bound >= slowest.share) continue;
      if (reached < 0.5 * enough || depth >= kDeepest) {  // slow enough to tell
        slowest = {bound, path.start_of(k) + middle};
        if (reached < 0.5 * enough) return slowest;
        continue;
      }
      open.push_back({middle - 0.5 * half, 0.5 * half, depth + 1});
      open.push_back({middle + 0.5 * half, 0.5 * half, depth + 1});
    }
  }
  return slowest;
}

}  // namespace viapoint
