/// @file
/// The linear system of a Newton step for a function of b and b' at the nodes of a grid, whose
/// terms couple neighbours only.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace viapoint::path_timing {

/// b and b' at the nodes of a grid.
struct SquareRate {
  std::vector<double> value, slope;
};

/// Derivatives by (b0, b0', b1, b1').
using Four = std::array<double, 4>;

inline double dot(const Four& a, const Four& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/// Cubic Hermite basis at share x of a cell.
inline Four basis(double x, double h) {
  const double x2 = x * x, x3 = x2 * x;
  return {1 - 3 * x2 + 2 * x3, h * (x - 2 * x2 + x3), 3 * x2 - 2 * x3, h * (x3 - x2)};
}

/// Its first and second derivatives by s.
inline Four basis_slope(double x, double h) {
  const double x2 = x * x;
  return {(6 * x2 - 6 * x) / h, 1 - 4 * x + 3 * x2, (6 * x - 6 * x2) / h, 3 * x2 - 2 * x};
}
inline Four basis_bend(double x, double h) {
  const double h2 = h * h;
  return {(12 * x - 6) / h2, (6 * x - 4) / h, (6 - 12 * x) / h2, (6 * x - 2) / h};
}

/// Gradient and block tridiagonal Hessian, and what the step length needs.
struct NewtonSystem {
  struct Block {
    double bb = 0.0, bs = 0.0, ss = 0.0;  ///< symmetric
  };
  struct Link {
    double bb = 0.0, bs = 0.0, sb = 0.0, ss = 0.0;  ///< row: this node, column: the next
  };
  std::vector<Block> diagonal;
  std::vector<Link> upper;
  std::vector<double> gradient_b, gradient_s;
  std::vector<double> acceleration_above, acceleration_below;  ///< inverse slacks of the rows
  std::vector<double> jerk_above, jerk_below;
  double objective = 0.0;

  NewtonSystem(size_t nodes, size_t acceleration_rows, size_t jerk_rows)
      : diagonal(nodes),
        upper(nodes),
        gradient_b(nodes),
        gradient_s(nodes),
        acceleration_above(acceleration_rows),
        acceleration_below(acceleration_rows),
        jerk_above(jerk_rows),
        jerk_below(jerk_rows) {}

  void clear() {
    std::fill(diagonal.begin(), diagonal.end(), Block{});
    std::fill(upper.begin(), upper.end(), Link{});
    std::fill(gradient_b.begin(), gradient_b.end(), 0.0);
    std::fill(gradient_s.begin(), gradient_s.end(), 0.0);
    objective = 0.0;
  }

  /// weight · v vᵀ and grad · v between node k and the next.
  void add(size_t k, const Four& v, double grad, double weight) {
    gradient_b[k] += grad * v[0];
    gradient_s[k] += grad * v[1];
    gradient_b[k + 1] += grad * v[2];
    gradient_s[k + 1] += grad * v[3];
    const double w0 = weight * v[0], w1 = weight * v[1], w2 = weight * v[2];
    diagonal[k].bb += w0 * v[0];
    diagonal[k].bs += w0 * v[1];
    diagonal[k].ss += w1 * v[1];
    upper[k].bb += w0 * v[2];
    upper[k].bs += w0 * v[3];
    upper[k].sb += w1 * v[2];
    upper[k].ss += w1 * v[3];
    diagonal[k + 1].bb += w2 * v[2];
    diagonal[k + 1].bs += w2 * v[3];
    diagonal[k + 1].ss += weight * v[3] * v[3];
  }

  /// weight · (v wᵀ + w vᵀ) between node k and the next.
  void add_mixed(size_t k, const Four& v, const Four& w, double weight) {
    const Four a{weight * v[0], weight * v[1], weight * v[2], weight * v[3]};
    diagonal[k].bb += 2 * a[0] * w[0];
    diagonal[k].bs += a[0] * w[1] + a[1] * w[0];
    diagonal[k].ss += 2 * a[1] * w[1];
    upper[k].bb += a[0] * w[2] + a[2] * w[0];
    upper[k].bs += a[0] * w[3] + a[3] * w[0];
    upper[k].sb += a[1] * w[2] + a[2] * w[1];
    upper[k].ss += a[1] * w[3] + a[3] * w[1];
    diagonal[k + 1].bb += 2 * a[2] * w[2];
    diagonal[k + 1].bs += a[2] * w[3] + a[3] * w[2];
    diagonal[k + 1].ss += 2 * a[3] * w[3];
  }

  /// b' = tie · b at both ends: the slope there is no unknown of its own.
  /// @pre at least two nodes
  void tie_ends(double start, double end) {
    const auto tie = [this](size_t k, double t) {
      Block& d = diagonal[k];
      d = {d.bb + 2 * t * d.bs + t * t * d.ss, 0.0, 1.0};
      gradient_b[k] += t * gradient_s[k];
      gradient_s[k] = 0.0;
    };
    const size_t last = diagonal.size() - 1;
    tie(0, start);
    Link& first = upper[0];
    first = {first.bb + start * first.sb, first.bs + start * first.ss, 0.0, 0.0};
    tie(last, end);
    Link& before = upper[last - 1];
    before = {before.bb + end * before.bs, 0.0, before.sb + end * before.ss, 0.0};
  }

  /// Solves Hessian · step = -gradient by block Cholesky; false if it is not positive definite.
  [[nodiscard]] bool solve(SquareRate& step) const;
};

}  // namespace viapoint::path_timing
