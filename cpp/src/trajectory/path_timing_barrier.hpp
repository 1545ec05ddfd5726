/// @file
/// The quickest ṡ² along a grid under velocity, acceleration and jerk of every joint, by an
/// interior-point method.
///
/// With b(s) = ṡ², s̈ = b'/2 and s⃛ = b''√b/2, so time is ∫ b^{-1/2} ds (Verscheure et al. 2009) and
///     q̇ = q'√b,   q̈ = q''b + q'b'/2,   |q'''b + 3/2 q''b' + 1/2 q'b''| <= j b^{-1/2}.
/// The tool's speed is one more ceiling of b, and its acceleration p''b + p'b'/2 is to stay in a
/// ball: a cone in (b, b'), with the barrier -log(1 - |y|²) of its two parts y, along the motion
/// and across it. b is a cubic in every cell with b, b' shared at the nodes: b'' is linear and may
/// jump, as the jerk of the quickest motion does. All is linear in the unknowns but b^{-1/2}, which
/// is convex: its tangent lies below, so limits held with the tangent hold in truth (convex–concave
/// procedure, Lipp & Boyd 2016), and every iterate is feasible. Each Newton step of the log barrier
/// takes a new tangent and costs one banded solution, O(nodes).
///
/// Where cells of different scale of s meet, b and b' at the node are those by the cell before; the
/// cell after sees them times gear² and gear.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "trajectory/path_timing_course.hpp"
#include "trajectory/path_timing_grid.hpp"
#include "trajectory/path_timing_newton.hpp"
#include "trajectory/path_timing_places.hpp"
#include "trajectory/path_timing_span.hpp"

namespace viapoint::path_timing {

/// What a start may use of the limits: far enough from them that the first steps are long.
inline constexpr double kFeasibleRoom = 0.95;

class BarrierProblem {
 public:
  BarrierProblem(const Course& course, const Grid& grid);

  /// A strictly feasible start out of the grid's guess.
  [[nodiscard]] SquareRate start() const;
  /// Scales `rate` down until it uses at most `room` of every limit: where it must be, `rounds`
  /// times, then all of it.
  void make_feasible(SquareRate& rate, int rounds, double room) const;
  /// Goes to the central path from `rate`, which must be strictly feasible.
  /// @param from weight of the barrier for which `rate` is about central; `weight`, if for none
  /// @param weight the one to come to, as a share of time: what is left to gain is about that times
  ///        two (the limits active in a cell)
  /// @returns false if the numbers gave out
  [[nodiscard]] bool solve(SquareRate& rate, double from, double weight);

  /// Motion along the cells, C² in time.
  [[nodiscard]] std::vector<TimedSpan> spans(const SquareRate& rate) const {
    return spans(rate, held_cells(rate));
  }
  /// @param held cells in which the tool's speed is held exactly: a part of held_cells()
  [[nodiscard]] std::vector<TimedSpan> spans(const SquareRate& rate,
                                             const std::vector<bool>& held) const;
  /// Cells so near the speed to be held that they are to be held exactly.
  [[nodiscard]] std::vector<bool> held_cells(const SquareRate& rate) const;
  /// Shares that the model sees in each cell, at its places.
  [[nodiscard]] std::vector<Shares> shares(const SquareRate& rate) const;
  /// What the limits of each cell are multiplied by.
  [[nodiscard]] Shares limit_factors(size_t cell) const { return cells_[cell].factor; }
  /// Weight of the ceilings on speed as a share of that of all other limits; 1 at first.
  void set_ceiling_weight(double share) { ceiling_weight_ = share; }
  void set_limit_factors(const std::vector<Shares>& factors);

 private:
  /// Rows come in pairs, the last one filled up with zeros.
  using Pair = Eigen::Array2d;
  /// |b · value + b' · slope| <= 1, by share of an acceleration limit.
  struct AccelerationRows {
    Pair b, slope;
  };
  /// |b · value + h b' · slope + h² b'' · bend| <= b^{-1/2}, by share of a jerk limit.
  struct JerkRows {
    Pair b, slope, bend;
  };
  /// |(b · value + slope · b', normal · value)| <= 1, by share of an acceleration of the tool.
  struct ConeRow {
    double b, slope, normal;
    double y = 0.0, across = 0.0, inverse = 1.0;  ///< in use: both parts, 1 / (1 - |y|²)
  };
  /// The same in the middle of a cell, by its four numbers.
  struct CellCone {
    Four along, across;
    double y = 0.0, n = 0.0, inverse = 1.0;
  };
  /// Of a pair of two-sided rows: what is used, y, and 1 / (1 - y²).
  struct Use {
    Pair y, inverse;
  };
  /// The same of a straight cell: of jerk at kStraightPlaces, then of acceleration in the middle.
  struct StraightUse {
    std::array<double, kStraightPlaces.size() + 1> y{}, inverse{};
  };
  struct Node {
    double ceiling = 0.0;       ///< of b, from velocity
    double most = 0.0;          ///< likewise, with the factors of the cells and the ramps
    double room = 1.0;          ///< factor on the acceleration limits
    size_t begin = 0, end = 0;  ///< rows
    size_t first_cone = 0, last_cone = 0;
  };
  struct CellRows {
    double length = 0.0, gear = 1.0;
    /// Of the inner Bernstein coefficients of b, which bound it between the nodes.
    std::array<double, 2> ceiling{};
    bool held = false;  ///< the tool's speed is to be kept there
    /// Rows of a straight cell, which has no others: of jerk by h² b'', of acceleration by h b'.
    double straight_jerk = 0.0, straight_acceleration = 0.0;
    size_t begin = 0, end = 0;  ///< rows of jerk at all places
    size_t middle = 0;          ///< the first row of acceleration in the middle
    size_t first_cone = 0, last_cone = 0;
    Shares factor{1.0, 1.0, 1.0};  ///< on the limits

    [[nodiscard]] double most(size_t inner) const {
      return ceiling[inner] * factor.velocity * factor.velocity;
    }
    [[nodiscard]] bool straight() const { return straight_jerk > 0.0; }
    /// Pairs of rows at one place.
    [[nodiscard]] size_t pairs() const { return (end - begin) / kCurvedPlaces.size(); }
    [[nodiscard]] Four numbers(const NodeRate& from, const NodeRate& to) const {
      return {gear * gear * from.value, length * gear * from.slope, to.value, length * to.slope};
    }
  };

  void add_cell(const Cell& cell, bool inner);
  void set_inner_ceilings(size_t cell);
  [[nodiscard]] bool about_held(size_t cell, const SquareRate& rate) const;
  /// True where the cell can begin, or end, at exactly that speed with hardly any jerk more in its
  /// neighbour.
  [[nodiscard]] bool can_be_met(size_t cell, bool at_start, const SquareRate& rate) const;
  void add_node(const Cell& before, const Cell& after);
  void add_acceleration_rows(size_t stretch, double s, double gear);
  [[nodiscard]] double rate_ceiling(size_t stretch, double s) const;
  [[nodiscard]] double ramp_ceiling(size_t stretch, double from, double to, bool leaving) const;
  void set_ceilings();
  /// Gradient of the barrier with one weight, curvature with another. Returns the time.
  double assemble(const SquareRate& rate, double weight, double curvature, NewtonSystem& newton);
  double assemble_cell(size_t k, const SquareRate& rate, double weight, double curvature,
                       NewtonSystem& newton);
  void assemble_straight(size_t cell, const Four& x, double weight, double curvature,
                         CellTerms& terms);
  void assemble_curved(const CellRows& cell, const Four& x, double weight, double curvature,
                       CellTerms& terms);
  void assemble_node(size_t k, const NodeRate& rate, double weight, double curvature,
                     NewtonSystem& newton);
  [[nodiscard]] double largest_step(const SquareRate& rate, const SquareRate& step) const;
  [[nodiscard]] double jerk_share(size_t cell, const SquareRate& rate) const;
  [[nodiscard]] double start_tie() const { return 4.0 / 3.0 / cells_.front().length; }
  [[nodiscard]] double end_tie() const { return -4.0 / 3.0 / cells_.back().length; }

  const Course* course_;
  Grid grid_;
  bool holds_;  ///< a speed somewhere: there time cannot be stretched
  std::vector<Node> nodes_;
  std::vector<CellRows> cells_;
  std::vector<AccelerationRows> acceleration_rows_;
  std::vector<ConeRow> cones_;
  std::vector<CellCone> cell_cones_;
  std::vector<JerkRows> jerk_rows_;
  std::vector<AccelerationRows> middle_rows_;                  ///< of curved cells, b' as h b'
  std::vector<Use> acceleration_use_, jerk_use_, middle_use_;  ///< of the rows
  std::vector<StraightUse> straight_use_;                      ///< of the cells
  double ceiling_weight_ = 1.0;
  double start_ceiling_ = 0.0, end_ceiling_ = 0.0;
};

}  // namespace viapoint::path_timing
