// The rows of a BarrierProblem: what every joint's limits say at the nodes and places of the cells.
#include <algorithm>
#include <cmath>
#include <limits>

#include "trajectory/path_timing_barrier.hpp"

namespace viapoint::path_timing {

BarrierProblem::BarrierProblem(const JointPath& path, const JointLimits& limits, const Grid& grid)
    : path_(&path), limits_(&limits), grid_(grid) {
  const size_t cells = grid.cells.size();
  cells_.resize(cells);
  nodes_.resize(cells - 1);
  for (size_t k = 0; k < cells; ++k) {
    const Cell& cell = grid.cells[k];
    const JointPiece& piece = path.pieces()[cell.piece];
    CellRows& rows = cells_[k];
    rows.length = cell.length();
    const PathPoint left = piece.at(cell.s0), right = piece.at(cell.s1);
    const bool inner = k > 0 && k + 1 < cells;
    if (inner) {
      const double h = rows.length;
      const auto add = [&](double x, const PathPoint& p) {
        Place& place = rows.places[rows.count++];
        place.value = basis(x, h);
        place.slope = basis_slope(x, h);
        place.bend = basis_bend(x, h);
        add_jerk_rows(p, piece, place.rows);
      };
      add(0.0, left);
      add(1.0, right);
      if (piece.coefficients.bottomRows<4>().any()) add(0.5, piece.at(0.5 * (cell.s0 + cell.s1)));
    }
    const auto ceiling = [&](const PathPoint& p) {
      double v = 1.0 / piece.rate_limit;
      for (int i = 0; i < piece.joints(); ++i) {
        v = std::max(v, std::abs(p.q1[i]) / (limits.velocity[i] * piece.scale));
      }
      return 1.0 / (v * v);
    };
    if (k + 1 < cells) {
      nodes_[k].ceiling = ceiling(right);
      // A knot between pieces that differ in their limits obeys the stricter: rows of both.
      const Cell& next = grid.cells[k + 1];
      const JointPiece& after = path.pieces()[next.piece];
      Rows& acceleration = nodes_[k].acceleration;
      acceleration.begin = acceleration_rows_.size();
      const bool differs =
          after.scale != piece.scale || after.rate_change_limit != piece.rate_change_limit;
      if (differs) add_acceleration_rows(right, piece, acceleration);
      add_acceleration_rows(next.piece == cell.piece ? right : after.at(next.s0), after,
                            acceleration);
    }
    if (k > 0) nodes_[k - 1].ceiling = std::min(nodes_[k - 1].ceiling, ceiling(left));
  }
  start_ceiling_ = ramp_ceiling(path.pieces().front(), 0.0, grid.cells.front().s1, true);
  end_ceiling_ =
      ramp_ceiling(path.pieces().back(), grid.cells.back().s0, grid.cells.back().s1, false);
  // A speed that nothing bounds gets a ceiling far above the rest.
  double least = std::min(start_ceiling_, end_ceiling_);
  for (const NodeRows& node : nodes_) least = std::min(least, node.ceiling);
  for (NodeRows& node : nodes_) node.ceiling = std::min(node.ceiling, 1e12 * least);
}

void BarrierProblem::add_acceleration_rows(const PathPoint& p, const JointPiece& piece,
                                           Rows& rows) {
  // Joints that do not bend here differ by one factor only: the strictest is enough.
  double straight = 0.5 / piece.rate_change_limit;
  for (int i = 0; i < piece.joints(); ++i) {
    const double per_limit = 1.0 / (limits_->acceleration[i] * piece.scale);
    if (p.q2[i] == 0.0) {
      straight = std::max(straight, 0.5 * std::abs(p.q1[i]) * per_limit);
    } else {
      acceleration_rows_.push_back({p.q2[i] * per_limit, 0.5 * p.q1[i] * per_limit});
    }
  }
  if (straight > 0.0) acceleration_rows_.push_back({0.0, straight});
  rows.end = acceleration_rows_.size();
}

void BarrierProblem::add_jerk_rows(const PathPoint& p, const JointPiece& piece, Rows& rows) {
  rows.begin = jerk_rows_.size();
  double straight = 0.0;
  for (int i = 0; i < piece.joints(); ++i) {
    const double per_limit = 1.0 / (limits_->jerk[i] * piece.scale);
    if (p.q2[i] == 0.0 && p.q3[i] == 0.0) {
      straight = std::max(straight, 0.5 * std::abs(p.q1[i]) * per_limit);
    } else {
      jerk_rows_.push_back(
          {p.q3[i] * per_limit, 1.5 * p.q2[i] * per_limit, 0.5 * p.q1[i] * per_limit});
    }
  }
  if (straight > 0.0) jerk_rows_.push_back({0.0, 0.0, straight});
  rows.end = jerk_rows_.size();
}

double BarrierProblem::ramp_ceiling(const JointPiece& piece, double from, double to,
                                    bool leaving) const {
  // Along the ramp ṡ = √b τ², s̈ = 2b/(3 s1) τ, s⃛ = 2b^{3/2}/(9 s1²) with τ the share of its time.
  constexpr int kInstants = 8;
  const double s1 = to - from;
  double ceiling = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= kInstants; ++k) {
    const double tau = static_cast<double>(k) / kInstants;
    const double along = s1 * tau * tau * tau;
    const PathPoint p = piece.at(leaving ? from + along : to - along);
    const double sign = leaving ? 1.0 : -1.0;
    double v = tau * tau / piece.rate_limit;
    double a = tau * 2.0 / (3.0 * s1) / piece.rate_change_limit;
    double j = 0.0;
    for (int i = 0; i < piece.joints(); ++i) {
      const double per_scale = 1.0 / piece.scale;
      v = std::max(v, std::abs(p.q1[i]) * tau * tau / limits_->velocity[i] * per_scale);
      const double acceleration =
          p.q2[i] * tau * tau * tau * tau + sign * p.q1[i] * 2.0 / (3.0 * s1) * tau;
      a = std::max(a, std::abs(acceleration) / limits_->acceleration[i] * per_scale);
      const double t3 = tau * tau * tau;
      const double jerk =
          p.q3[i] * t3 * t3 + sign * p.q2[i] * 2.0 / s1 * t3 + p.q1[i] * 2.0 / (9.0 * s1 * s1);
      j = std::max(j, std::abs(jerk) / limits_->jerk[i] * per_scale);
    }
    ceiling = std::min({ceiling, 1.0 / (v * v), 1.0 / a, 1.0 / std::cbrt(j * j)});
  }
  return ceiling;
}

}  // namespace viapoint::path_timing
