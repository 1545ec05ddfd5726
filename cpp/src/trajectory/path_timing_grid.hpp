/// @file
/// Where along a section the timing gets its nodes, and a first guess of the speed there.
#pragma once

#include <vector>

#include "trajectory/path_timing_course.hpp"
#include "trajectory/path_timing_newton.hpp"

namespace viapoint::path_timing {

/// A part of one stretch, s being its σ.
struct Cell {
  size_t piece = 0;
  double s0 = 0.0, s1 = 0.0;
  double gear = 1.0;  ///< ṡ in this cell over ṡ in the one before, where they meet

  [[nodiscard]] double length() const { return s1 - s0; }
};

/// Cells from the start of a section to its end, with nodes between neighbours: one node fewer than
/// cells. In the first and the last cell the section leaves rest and comes to rest.
struct Grid {
  std::vector<Cell> cells;
  std::vector<double> square_rate;  ///< guess of ṡ² at the nodes, in the scale of the cell before

  [[nodiscard]] size_t nodes() const { return square_rate.size(); }
};

/// Cells of about equal change: near rest and near slow places the speed along a motion of constant
/// jerk scales with a length w = ṡ^{3/2} / √(9/2 s⃛), and cells are a share of that.
/// @returns two nodes at least, every cell and every guess positive and finite; an empty grid where
///          the numbers leave the range of doubles
[[nodiscard]] Grid make_grid(const Course& course);

/// The grid with the cells in two halves that `split` names; not the first nor the last one.
/// @param rate b and b' at the nodes: those of the new nodes are put in between
[[nodiscard]] Grid refine(const Grid& grid, const std::vector<bool>& split, SquareRate& rate);

}  // namespace viapoint::path_timing
