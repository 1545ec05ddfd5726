/// @file
/// The linear system of a Newton step for a function of b and b' at the nodes of a grid, whose
/// terms couple neighbours only.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace viapoint::path_timing {

/// b and b' at a node.
struct NodeRate {
  double value = 0.0, slope = 0.0;
};
/// At all nodes.
using SquareRate = std::vector<NodeRate>;

/// By the four numbers of a cell, all of the same unit: b, h b' at its start, b, h b' at its end,
/// with h its length.
using Four = std::array<double, 4>;

inline double dot(const Four& a, const Four& b) {
  return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

/// Cubic Hermite basis at share x of a cell: b there.
constexpr Four basis(double x) {
  const double x2 = x * x, x3 = x2 * x;
  return {1 - 3 * x2 + 2 * x3, x - 2 * x2 + x3, 3 * x2 - 2 * x3, x3 - x2};
}
/// h b' and h² b'' there.
constexpr Four basis_slope(double x) {
  const double x2 = x * x;
  return {6 * x2 - 6 * x, 1 - 4 * x + 3 * x2, 6 * x - 6 * x2, 3 * x2 - 2 * x};
}
constexpr Four basis_bend(double x) { return {12 * x - 6, 6 * x - 4, 6 - 12 * x, 6 * x - 2}; }

/// Gradient and Hessian of the terms of one cell, by its four numbers.
struct CellTerms {
  Four gradient{};
  std::array<double, 10> hessian{};  ///< upper triangle, row by row

  /// slope · v and weight · v vᵀ.
  void add(const Four& v, double slope, double weight) {
    for (size_t i = 0, at = 0; i < 4; ++i) {
      gradient[i] += slope * v[i];
      const double w = weight * v[i];
      for (size_t j = i; j < 4; ++j) hessian[at++] += w * v[j];
    }
  }
  /// v mᵀ + m vᵀ.
  void add_symmetric(const Four& v, const Four& m) {
    for (size_t i = 0, at = 0; i < 4; ++i) {
      for (size_t j = i; j < 4; ++j) hessian[at++] += v[i] * m[j] + m[i] * v[j];
    }
  }
};

/// Gradient and block tridiagonal Hessian.
class NewtonSystem {
 public:
  explicit NewtonSystem(size_t nodes) : diagonal_(nodes), upper_(nodes), gradient_(nodes) {}

  void clear();
  /// Terms of the cell between node k and the next. @param length of the cell; @param gear the rate
  /// of s in it over that at node k
  void add(size_t k, const CellTerms& terms, double length, double gear);
  /// Terms of one node: gradient by b and b', second derivatives by bb, bb', b'b'.
  void add(size_t k, double gb, double gs, double bb, double bs, double ss) {
    gradient_[k].value += gb;
    gradient_[k].slope += gs;
    diagonal_[k].bb += bb;
    diagonal_[k].bs += bs;
    diagonal_[k].ss += ss;
  }
  /// b' = tie · b at both ends: the slope there is no unknown of its own.
  /// @pre at least two nodes; to be called once, after all terms
  void tie_ends(double start, double end);
  /// step = -Hessian⁻¹ gradient by block Cholesky, which overwrites the Hessian; false if it is not
  /// positive definite. With `decrement` = step · Hessian · step.
  [[nodiscard]] bool solve(SquareRate& step, double& decrement);

 private:
  struct Block {
    double bb = 0.0, bs = 0.0, ss = 0.0;  ///< symmetric
  };
  struct Link {
    double bb = 0.0, bs = 0.0, sb = 0.0, ss = 0.0;  ///< row: this node, column: the next
  };
  std::vector<Block> diagonal_;
  std::vector<Link> upper_;
  std::vector<NodeRate> gradient_;
  double start_tie_ = 0.0, end_tie_ = 0.0;
};

}  // namespace viapoint::path_timing
