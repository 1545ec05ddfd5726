// The rows of a BarrierProblem: what every joint's limits say at the nodes and places of the cells.
#include <algorithm>
#include <cmath>
#include <limits>

#include "trajectory/path_timing_barrier.hpp"
#include "trajectory/path_timing_hold.hpp"
#include "trajectory/path_timing_tool.hpp"

namespace viapoint::path_timing {

BarrierProblem::BarrierProblem(const Course& course, const Grid& grid)
    : course_(&course), grid_(grid), holds_(course.holds_speed()) {
  const size_t cells = grid.cells.size();
  const size_t pairs = static_cast<size_t>(course.joints() + 1) / 2;
  cells_.reserve(cells);
  nodes_.reserve(cells);
  jerk_rows_.reserve(cells * kCurvedPlaces.size() * pairs);
  acceleration_rows_.reserve(cells * (pairs + 1));
  middle_rows_.reserve(cells * pairs);
  for (size_t k = 0; k < cells; ++k) {
    add_cell(grid.cells[k], k > 0 && k + 1 < cells);
    if (k + 1 < cells) add_node(grid.cells[k], grid.cells[k + 1]);
  }
  const Cell& first = grid.cells.front();
  const Cell& last = grid.cells.back();
  start_ceiling_ = ramp_ceiling(first.piece, first.s0, first.s1, true);
  end_ceiling_ = ramp_ceiling(last.piece, last.s0, last.s1, false);
  // A speed that nothing bounds gets a ceiling far above the rest.
  double least = std::min(start_ceiling_, end_ceiling_);
  for (const Node& node : nodes_) least = std::min(least, node.ceiling);
  for (Node& node : nodes_) node.ceiling = std::min(node.ceiling, 1e12 * least);
  for (size_t k = 1; k + 1 < cells; ++k) set_inner_ceilings(k);
  acceleration_use_.resize(acceleration_rows_.size());
  jerk_use_.resize(jerk_rows_.size());
  middle_use_.resize(middle_rows_.size());
  straight_use_.resize(cells_.size());
  set_ceilings();
}

void BarrierProblem::add_cell(const Cell& cell, bool inner) {
  const Stretch& stretch = course_->stretches()[cell.piece];
  CellRows rows;
  rows.length = cell.length();
  rows.gear = cell.gear;
  rows.begin = jerk_rows_.size();
  rows.middle = middle_rows_.size();
  rows.held = inner && is_held(stretch);
  const double h = rows.length;
  if (inner && stretch.straight) {
    rows.straight_jerk = 0.5 / (stretch.jerk_limit * h * h);
    rows.straight_acceleration = 0.5 / (stretch.change_limit * h);
  } else if (inner) {
    JointRates rates;
    const auto joints = static_cast<size_t>(course_->joints());
    for (const Place& place : kCurvedPlaces) {
      course_->rates(cell.piece, cell.s0 + place.at * h, rates);
      for (size_t i = 0; i < joints; i += 2) {
        const auto pair = [i](const auto& values) { return Pair(values[i], values[i + 1]); };
        jerk_rows_.push_back(
            {pair(rates.jerk3), 1.5 / h * pair(rates.jerk2), 0.5 / (h * h) * pair(rates.jerk1)});
        if (place.at == kMiddle.at) {
          middle_rows_.push_back({pair(rates.acceleration2), 0.5 / h * pair(rates.acceleration1)});
        }
      }
    }
  }
  rows.end = jerk_rows_.size();
  rows.first_cone = cell_cones_.size();
  if (inner && stretch.tool != nullptr) {
    for (const ToolCone& cone : tool_at(stretch, cell.s0 + kMiddle.at * h).cones) {
      if (!cone.counts()) continue;
      CellCone row;
      for (size_t i = 0; i < 4; ++i) {
        row.along[i] = cone.b * kMiddle.value[i] + 0.5 / h * cone.slope * kMiddle.slope[i];
        row.across[i] = cone.normal * kMiddle.value[i];
      }
      cell_cones_.push_back(row);
    }
  }
  rows.last_cone = cell_cones_.size();
  cells_.push_back(rows);
}

void BarrierProblem::set_inner_ceilings(size_t k) {
  constexpr double kLeast = 0.1;
  CellRows& rows = cells_[k];
  const double start = rows.gear * rows.gear * nodes_[k - 1].ceiling, end = nodes_[k].ceiling;
  rows.ceiling.fill(std::max(start, end));
  const Cell& cell = grid_.cells[k];
  const Stretch& stretch = course_->stretches()[cell.piece];
  if (!holds_ || !limits_speed(stretch)) return;
  // b is to follow the ceiling of the tool's speed, so its cubic is held against that of C.
  const NodeRate from = speed_ceiling(stretch, cell.s0), to = speed_ceiling(stretch, cell.s1);
  const std::array<double, 2> inner{from.value + rows.length * from.slope / 3.0,
                                    to.value - rows.length * to.slope / 3.0};
  for (size_t i = 0; i < inner.size(); ++i) {
    if (!std::isfinite(inner[i])) continue;
    const double least = kLeast * std::min(start, end);
    rows.ceiling[i] = std::clamp(inner[i], least, std::max(least, rows.ceiling[i]));
  }
}

void BarrierProblem::add_node(const Cell& before, const Cell& after) {
  const Stretch& here = course_->stretches()[before.piece];
  const Stretch& next = course_->stretches()[after.piece];
  Node node;
  node.begin = acceleration_rows_.size();
  node.first_cone = cones_.size();
  node.ceiling = std::min(rate_ceiling(before.piece, before.s1),
                          rate_ceiling(after.piece, after.s0) / (after.gear * after.gear));
  // A knot between pieces that differ in their limits obeys the stricter: rows of both. Otherwise
  // one will do, and best that of a straight piece.
  const bool knot = before.piece != after.piece;
  const bool same =
      here.geometry->scale == next.geometry->scale && here.geometry->tool == next.geometry->tool;
  if (!knot || !same || here.straight || !next.straight) {
    add_acceleration_rows(before.piece, before.s1, 1.0);
  }
  if (knot && (!same || (next.straight && !here.straight))) {
    add_acceleration_rows(after.piece, after.s0, after.gear);
  }
  node.end = acceleration_rows_.size();
  node.last_cone = cones_.size();
  nodes_.push_back(node);
}

void BarrierProblem::add_acceleration_rows(size_t stretch, double s, double gear) {
  const Stretch& here = course_->stretches()[stretch];
  if (here.straight) {
    acceleration_rows_.push_back({Pair::Zero(), Pair(0.5 * gear / here.change_limit, 0.0)});
    return;
  }
  JointRates rates;
  course_->rates(stretch, s, rates);
  for (size_t i = 0; i < static_cast<size_t>(course_->joints()); i += 2) {
    const auto pair = [i](const auto& values) { return Pair(values[i], values[i + 1]); };
    acceleration_rows_.push_back(
        {gear * gear * pair(rates.acceleration2), 0.5 * gear * pair(rates.acceleration1)});
  }
  if (here.tool == nullptr) return;
  for (const ToolCone& cone : tool_at(here, s).cones) {
    if (cone.counts()) {
      cones_.push_back({gear * gear * cone.b, 0.5 * gear * cone.slope, gear * gear * cone.normal});
    }
  }
}

double BarrierProblem::rate_ceiling(size_t stretch, double s) const {
  const Stretch& here = course_->stretches()[stretch];
  // Time that must not be stretched must not need it: see kHeldRoom.
  const double room = holds_ ? kHeldRoom : 1.0;
  if (here.straight) return here.rate_limit * here.rate_limit / (room * room);
  double v = 0.0;
  JointRates rates;
  course_->rates(stretch, s, rates);
  for (const double share : rates.velocity) v = std::max(v, std::abs(share));
  v *= room;
  if (here.tool != nullptr)
    v = std::max(v, (is_held(here) ? 1.0 : room) * tool_at(here, s).velocity);
  return 1.0 / (v * v);
}

double BarrierProblem::ramp_ceiling(size_t stretch, double from, double to, bool leaving) const {
  // Along the ramp ṡ = √b τ², s̈ = 2b/(3 s1) τ, s⃛ = 2b^{3/2}/(9 s1²) with τ the share of its time.
  constexpr int kInstants = 8;
  const Stretch& here = course_->stretches()[stretch];
  const double s1 = to - from;
  const double sign = leaving ? 1.0 : -1.0;
  double ceiling = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= kInstants; ++k) {
    const double tau = static_cast<double>(k) / kInstants;
    const double along = s1 * tau * tau * tau;
    JointRates rates;
    course_->rates(stretch, leaving ? from + along : to - along, rates);
    const double rate = tau * tau, change = sign * 2.0 / (3.0 * s1) * tau;
    double v = 0.0, a = 0.0, j = 0.0;
    for (size_t i = 0; i < static_cast<size_t>(course_->joints()); ++i) {
      v = std::max(v, std::abs(rates.velocity[i]) * rate);
      a = std::max(
          a, std::abs(rates.acceleration2[i] * rate * rate + rates.acceleration1[i] * change));
      j = std::max(
          j, std::abs(rates.jerk3[i] * rate * rate * rate + 3.0 * rates.jerk2[i] * rate * change +
                      rates.jerk1[i] * 2.0 / (9.0 * s1 * s1)));
    }
    if (here.tool != nullptr) {
      const ToolPlace tool = tool_at(here, leaving ? from + along : to - along);
      v = std::max(v, tool.velocity * rate);
      for (const ToolCone& cone : tool.cones) {
        a = std::max(
            a, std::hypot(cone.b * rate * rate + cone.slope * change, cone.normal * rate * rate));
      }
    }
    ceiling = std::min({ceiling, 1.0 / (v * v), 1.0 / a, 1.0 / std::cbrt(j * j)});
  }
  return ceiling;
}

void BarrierProblem::set_ceilings() {
  for (size_t k = 0; k < nodes_.size(); ++k) {
    const CellRows& before = cells_[k];
    const CellRows& after = cells_[k + 1];
    const double factor = std::min(before.factor.velocity, after.factor.velocity);
    nodes_[k].most = nodes_[k].ceiling * factor * factor;
    nodes_[k].room = std::min(before.factor.acceleration, after.factor.acceleration);
  }
  const auto by_jerk = [](double ceiling, double jerk) { return ceiling * std::cbrt(jerk * jerk); };
  nodes_.front().most =
      std::min(nodes_.front().most, by_jerk(start_ceiling_, cells_.front().factor.jerk));
  nodes_.back().most =
      std::min(nodes_.back().most, by_jerk(end_ceiling_, cells_.back().factor.jerk));
}

void BarrierProblem::set_limit_factors(const std::vector<Shares>& factors) {
  for (size_t k = 0; k < cells_.size(); ++k) cells_[k].factor = factors[k];
  set_ceilings();
}

}  // namespace viapoint::path_timing
