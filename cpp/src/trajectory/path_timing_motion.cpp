// What a BarrierProblem makes of its unknowns: shares of the limits, a feasible start, the motion.
#include <algorithm>
#include <cmath>

#include "trajectory/path_timing_barrier.hpp"
#include "trajectory/path_timing_hold.hpp"

namespace viapoint::path_timing {

SquareRate BarrierProblem::start() const {
  const size_t n = nodes_.size();
  SquareRate rate(n);
  for (size_t k = 0; k < n; ++k) rate[k].value = grid_.square_rate[k];
  // Slopes by the harmonic mean of the neighbours' (Fritsch & Butland 1984): the cubic is monotone
  // between nodes and so stays positive.
  const auto rise = [&](size_t k) {  // in the cell before node k, by its s
    const double gear = cells_[k].gear;
    return (rate[k].value - gear * gear * rate[k - 1].value) / cells_[k].length;
  };
  for (size_t k = 1; k + 1 < n; ++k) {
    const double before = rise(k), after = rise(k + 1) / cells_[k + 1].gear;
    rate[k].slope = before * after > 0.0 ? 2.0 * before * after / (before + after) : 0.0;
  }
  rate.front().slope = start_tie() * rate.front().value;
  rate.back().slope = end_tie() * rate.back().value;
  constexpr int kRounds = 5;
  make_feasible(rate, kRounds, kFeasibleRoom);
  return rate;
}

double BarrierProblem::jerk_share(size_t index, const SquareRate& rate) const {
  const CellRows& cell = cells_[index];
  const Four x = cell.numbers(rate[index - 1], rate[index]);
  if (cell.straight()) {
    double worst = 0.0;
    for (const Place& place : kStraightPlaces) {
      worst = std::max(worst, std::sqrt(dot(place.value, x)) * std::abs(dot(place.bend, x)));
    }
    return worst * cell.straight_jerk;
  }
  Pair worst = Pair::Zero();
  const size_t pairs = cell.pairs();
  size_t row = cell.begin;
  for (const Place& place : kCurvedPlaces) {
    const double b = dot(place.value, x), slope = dot(place.slope, x), bend = dot(place.bend, x);
    const double root = std::sqrt(b);
    for (const size_t end = row + pairs; row < end; ++row) {
      const JerkRows& rows = jerk_rows_[row];
      worst = worst.max(root * (b * rows.b + slope * rows.slope + bend * rows.bend).abs());
    }
  }
  return worst.maxCoeff();
}

std::vector<Shares> BarrierProblem::shares(const SquareRate& rate) const {
  std::vector<Shares> shares(cells_.size());
  for (size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    Pair worst = Pair::Zero();
    for (size_t r = node.begin; r < node.end; ++r) {
      const AccelerationRows& rows = acceleration_rows_[r];
      worst = worst.max((rate[k].value * rows.b + rate[k].slope * rows.slope).abs());
    }
    double acceleration = worst.maxCoeff();
    for (size_t r = node.first_cone; r < node.last_cone; ++r) {
      const ConeRow& cone = cones_[r];
      acceleration =
          std::max(acceleration, std::hypot(rate[k].value * cone.b + rate[k].slope * cone.slope,
                                            rate[k].value * cone.normal));
    }
    const Shares here{std::sqrt(rate[k].value / node.ceiling), acceleration, 0.0};
    shares[k].include(here);
    shares[k + 1].include(here);
  }
  for (size_t k = 1; k + 1 < cells_.size(); ++k) {
    shares[k].jerk = jerk_share(k, rate);
    const CellRows& cell = cells_[k];
    for (size_t r = cell.first_cone; r < cell.last_cone; ++r) {
      const Four x = cell.numbers(rate[k - 1], rate[k]);
      shares[k].acceleration =
          std::max(shares[k].acceleration,
                   std::hypot(dot(cell_cones_[r].along, x), dot(cell_cones_[r].across, x)));
    }
    if (!cell.straight()) {
      const Four x = cell.numbers(rate[k - 1], rate[k]);
      const double b = dot(kMiddle.value, x), slope = dot(kMiddle.slope, x);
      for (size_t r = cell.middle; r < cell.middle + cell.pairs(); ++r) {
        shares[k].acceleration =
            std::max(shares[k].acceleration,
                     (b * middle_rows_[r].b + slope * middle_rows_[r].slope).abs().maxCoeff());
      }
      continue;
    }
    const double slope = dot(kMiddle.slope, cell.numbers(rate[k - 1], rate[k]));
    shares[k].acceleration =
        std::max(shares[k].acceleration, cell.straight_acceleration * std::abs(slope));
  }
  const double start = rate.front().value / start_ceiling_;
  const double end = rate.back().value / end_ceiling_;
  shares.front().jerk = start * std::sqrt(start);
  shares.back().jerk = end * std::sqrt(end);
  return shares;
}

void BarrierProblem::make_feasible(SquareRate& rate, int rounds, double room) const {
  const size_t n = nodes_.size();
  std::vector<double> scale(n);
  for (int round = 0;; ++round) {
    std::vector<Shares> used = shares(rate);
    for (size_t k = 1; k + 1 < cells_.size(); ++k) {
      const Four x = cells_[k].numbers(rate[k - 1], rate[k]);
      const auto& ceiling = cells_[k].ceiling;
      const double inner =
          std::max((x[0] + x[1] / 3.0) / ceiling[0], (x[2] - x[3] / 3.0) / ceiling[1]);
      used[k].velocity = std::max(used[k].velocity, std::sqrt(std::max(0.0, inner)));
    }
    std::vector<double> excess(cells_.size());  // of ṡ in a cell
    for (size_t k = 0; k < cells_.size(); ++k) {
      const CellRows& cell = cells_[k];
      excess[k] =
          Shares{used[k].velocity / cell.factor.velocity,
                 used[k].acceleration / cell.factor.acceleration, used[k].jerk / cell.factor.jerk}
              .stretch();
    }
    double worst = 0.0;
    for (size_t k = 0; k < n; ++k) {
      scale[k] = std::max(excess[k], excess[k + 1]) / room;
      worst = std::max(worst, scale[k]);
    }
    if (worst <= 1.0) return;
    if (round == rounds) {
      for (NodeRate& node : rate) {
        node.value /= worst * worst;
        node.slope /= worst * worst;
      }
      return;
    }
    // Slower where it must be, less and less so further away, that b'' stays small.
    constexpr double kFade = 0.8;
    for (double& value : scale) value = value > 1.0 ? std::log(value) : 0.0;
    for (size_t k = 1; k < n; ++k) scale[k] = std::max(scale[k], kFade * scale[k - 1]);
    for (size_t k = n - 1; k-- > 0;) scale[k] = std::max(scale[k], kFade * scale[k + 1]);
    // The cubic stays positive: its Bernstein coefficients do.
    constexpr double kSteepest = 2.5;
    for (size_t k = 1; k + 1 < n; ++k) {
      const double length = cells_[k].length, next = cells_[k + 1].length / cells_[k + 1].gear;
      const double bend = -2.0 * (scale[k + 1] - scale[k - 1]) / (length + next);
      const double factor = scale[k] > 0.0 ? std::exp(-2.0 * scale[k]) : 1.0;
      const double slope = factor * (rate[k].slope + bend * rate[k].value);
      rate[k].value *= factor;
      rate[k].slope =
          std::clamp(slope, -kSteepest * rate[k].value / next, kSteepest * rate[k].value / length);
    }
    rate.front().value *= std::exp(-2.0 * scale.front());
    rate.back().value *= std::exp(-2.0 * scale.back());
    rate.front().slope = start_tie() * rate.front().value;
    rate.back().slope = end_tie() * rate.back().value;
  }
}

bool BarrierProblem::about_held(size_t k, const SquareRate& rate) const {
  constexpr double kNear = 2e-5;
  const CellRows& rows = cells_[k];
  if (!rows.held) return false;
  const Cell& cell = grid_.cells[k];
  const Stretch& stretch = course_->stretches()[cell.piece];
  const Four x = rows.numbers(rate[k - 1], rate[k]);
  const auto near = [&](double value, double slope, double sigma) {
    const NodeRate hold = hold_rate(stretch, sigma);
    return std::abs(value - hold.value) <= kNear * hold.value &&
           std::abs(slope - rows.length * hold.slope) <= kNear * hold.value;
  };
  return near(x[0], x[1], cell.s0) && near(x[2], x[3], cell.s1) &&
         holds_speed(stretch, hold_span(cell.piece, stretch, cell.s0, cell.s1));
}

bool BarrierProblem::can_be_met(size_t k, bool at_start, const SquareRate& rate) const {
  constexpr double kJerkShare = 0.02;
  const CellRows& rows = cells_[k];
  const Cell& cell = grid_.cells[k];
  const Four x = rows.numbers(rate[k - 1], rate[k]);
  const NodeRate hold = hold_rate(course_->stretches()[cell.piece], at_start ? cell.s0 : cell.s1);
  const double value = at_start ? x[0] : x[2], slope = at_start ? x[1] : x[3];
  double bend = 0.0;
  for (size_t r = rows.begin; r < rows.end; ++r) {
    bend = std::max(bend, jerk_rows_[r].bend.abs().maxCoeff());
  }
  // h² b'' of a cubic changes by 6 of b and 4 of h b' at an end at most.
  const double change =
      6.0 * std::abs(value - hold.value) + 4.0 * std::abs(slope - rows.length * hold.slope);
  return change * std::sqrt(hold.value) * bend <= kJerkShare;
}

std::vector<bool> BarrierProblem::held_cells(const SquareRate& rate) const {
  std::vector<bool> held(cells_.size(), false);
  for (size_t k = 1; k + 1 < cells_.size(); ++k) held[k] = about_held(k, rate);
  for (size_t k = 1; k + 1 < cells_.size(); ++k) {
    if (held[k] && !held[k - 1] && !can_be_met(k, true, rate)) held[k] = false;
  }
  for (size_t k = cells_.size() - 1; k-- > 1;) {
    if (held[k] && !held[k + 1] && !can_be_met(k, false, rate)) held[k] = false;
  }
  return held;
}

std::vector<TimedSpan> BarrierProblem::spans(const SquareRate& optimal,
                                             const std::vector<bool>& held) const {
  // What is as good as held is held exactly; a barrier alone never is.
  SquareRate rate = optimal;
  for (size_t k = 1; k + 1 < cells_.size(); ++k) {
    if (!held[k]) continue;
    const Cell& cell = grid_.cells[k];
    const Stretch& stretch = course_->stretches()[cell.piece];
    const NodeRate from = hold_rate(stretch, cell.s0);
    const double gear = cells_[k].gear;
    if (!held[k - 1]) rate[k - 1] = {from.value / (gear * gear), from.slope / gear};
    rate[k] = hold_rate(stretch, cell.s1);
  }
  std::vector<TimedSpan> spans;
  spans.reserve(cells_.size());
  for (size_t k = 0; k < cells_.size(); ++k) {
    const Cell& cell = grid_.cells[k];
    const CellRows& rows = cells_[k];
    RateState from{cell.s0, 0.0, 0.0}, to{cell.s1, 0.0, 0.0};
    if (k > 0) {
      from.rate = rows.gear * std::sqrt(rate[k - 1].value);
      from.change = 0.5 * rows.gear * rate[k - 1].slope;
    }
    if (k + 1 < cells_.size()) {
      to.rate = std::sqrt(rate[k].value);
      to.change = 0.5 * rate[k].slope;
    }
    double time = 0.0;
    if (k == 0 || k + 1 == cells_.size()) {
      time = 3.0 * rows.length / std::max(from.rate, to.rate);
    } else if (held[k]) {
      time = hold_time(course_->stretches()[cell.piece], cell.s0, cell.s1);
    } else {
      const Four x = rows.numbers(rate[k - 1], rate[k]);
      for (const Quadrature& q : kGauss5) time += q.weight / std::sqrt(dot(q.value, x));
      time *= rows.length;
    }
    const double length = course_->stretches()[cell.piece].length;
    spans.push_back(TimedSpan::between(cell.piece, length, from, to, time));
  }
  return spans;
}

}  // namespace viapoint::path_timing
