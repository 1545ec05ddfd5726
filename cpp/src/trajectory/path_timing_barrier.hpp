/// @file
/// The quickest ṡ² along a grid under velocity, acceleration and jerk of every joint, by an
/// interior-point method.
///
/// With b(s) = ṡ², s̈ = b'/2 and s⃛ = b''√b/2, so time is ∫ b^{-1/2} ds (Verscheure et al. 2009) and
///     q̇ = q'√b,   q̈ = q''b + q'b'/2,   |q'''b + 3/2 q''b' + 1/2 q'b''| <= j b^{-1/2}.
/// b is a cubic in every cell with b, b' shared at the nodes: b'' is linear and may jump, as the
/// jerk of the quickest motion does. All is linear in the unknowns but b^{-1/2}, which is convex:
/// its tangent lies below, so limits held with the tangent hold in truth (convex–concave procedure,
/// Lipp & Boyd 2016), and every iterate is feasible. Each Newton step of the log barrier takes a
/// new tangent and costs one banded solution, O(nodes).
#pragma once

#include <array>
#include <vector>

#include "trajectory/path_timing_grid.hpp"
#include "trajectory/path_timing_newton.hpp"
#include "trajectory/path_timing_span.hpp"

namespace viapoint::path_timing {

class BarrierProblem {
 public:
  BarrierProblem(const JointPath& path, const JointLimits& limits, const Grid& grid);

  /// A strictly feasible start out of the grid's guess.
  [[nodiscard]] SquareRate start() const;
  /// Scales `rate` down until it keeps every limit with some room: where it must be, `rounds`
  /// times, then all of it.
  void make_feasible(SquareRate& rate, int rounds) const;
  /// Follows the central path from `rate`, which must be strictly feasible.
  /// @param weight, last_weight first and last weight of the barrier, as a share of time: what is
  ///        left to gain is about the last weight times two (the limits active in a cell)
  /// @returns false if the numbers gave out
  [[nodiscard]] bool solve(SquareRate& rate, double weight, double last_weight) const;

  /// Motion along the cells, C² in time.
  [[nodiscard]] std::vector<TimedSpan> spans(const SquareRate& rate) const;
  /// Shares that the model sees in each cell, at its places.
  [[nodiscard]] std::vector<Shares> shares(const SquareRate& rate) const;
  /// Multiplies the limits of each cell.
  void scale_limits(const std::vector<Shares>& factors);

 private:
  struct AccelerationRow {
    double b, slope;
  };
  struct JerkRow {
    double b, slope, bend;
  };
  struct Rows {
    size_t begin = 0, end = 0;
  };
  struct NodeRows {
    double ceiling = 0.0;  ///< of b, from velocity
    Rows acceleration;
  };
  /// Jerk rows at share x of a cell; b, b', b'' there by the cell's four unknowns.
  struct Place {
    Four value{}, slope{}, bend{};
    Rows rows;
  };
  struct CellRows {
    double length = 0.0;
    std::array<Place, 3> places;
    size_t count = 0;                                       ///< of places
    double velocity = 1.0, acceleration = 1.0, jerk = 1.0;  ///< factors on the limits
  };

  void add_acceleration_rows(const PathPoint& p, const JointPiece& piece, Rows& rows);
  void add_jerk_rows(const PathPoint& p, const JointPiece& piece, Rows& rows);
  double ramp_ceiling(const JointPiece& piece, double from, double to, bool leaving) const;
  double largest_step(const SquareRate& rate, const SquareRate& step,
                      const NewtonSystem& newton) const;
  /// Gradient of the barrier with one weight, curvature with another.
  void assemble(const SquareRate& rate, double weight, double curvature,
                NewtonSystem& newton) const;
  double start_tie() const { return 4.0 / 3.0 / cells_.front().length; }
  double end_tie() const { return -4.0 / 3.0 / cells_.back().length; }

  const JointPath* path_;
  const JointLimits* limits_;
  Grid grid_;
  std::vector<NodeRows> nodes_;
  std::vector<CellRows> cells_;
  std::vector<AccelerationRow> acceleration_rows_;
  std::vector<JerkRow> jerk_rows_;
  double start_ceiling_ = 0.0, end_ceiling_ = 0.0;
};

}  // namespace viapoint::path_timing
