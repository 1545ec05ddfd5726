#include "trajectory/path_timing_barrier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viapoint::path_timing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Inner Bernstein coefficients of b by the cell's four numbers.
constexpr std::array<Four, 2> kInner{{{1.0, 1.0 / 3.0, 0.0, 0.0}, {0.0, 0.0, 1.0, -1.0 / 3.0}}};
/// The barriers of a cell share what is given to one of its places.
constexpr double kPlaces = 3.0;

}  // namespace

double BarrierProblem::assemble(const SquareRate& rate, double weight, double curvature,
                                NewtonSystem& newton) {
  newton.clear();
  // Time in each cell, of which the barriers there get a share.
  const double first = 3.0 * cells_.front().length / std::sqrt(rate.front().value);
  const double last = 3.0 * cells_.back().length / std::sqrt(rate.back().value);
  const auto ramp = [&](size_t k, double time) {
    const double b = rate[k].value;
    newton.add(k, -0.5 * time / b, 0.0, 0.75 * time / (b * b), 0.0, 0.0);
  };
  ramp(0, first);
  ramp(nodes_.size() - 1, last);
  double before = first, sum = first + last;
  for (size_t k = 0; k < nodes_.size(); ++k) {
    const bool inner = k + 1 < nodes_.size();
    const double after = inner ? assemble_cell(k, rate, weight, curvature, newton) : last;
    if (inner) sum += after;
    const double share = 0.5 * (before + after);
    assemble_node(k, rate[k], weight * share, curvature * share, newton);
    before = after;
  }
  newton.tie_ends(start_tie(), end_tie());
  return sum;
}

double BarrierProblem::assemble_cell(size_t k, const SquareRate& rate, double weight,
                                     double curvature, NewtonSystem& newton) {
  const CellRows& cell = cells_[k + 1];
  const Four x = cell.numbers(rate[k], rate[k + 1]);
  CellTerms terms;
  double time = 0.0;
  for (const Quadrature& q : kGauss3) {
    const double inverse = 1.0 / dot(q.value, x);
    const double f = q.weight * cell.length * std::sqrt(inverse);
    time += f;
    terms.add(q.value, -0.5 * f * inverse, 0.75 * f * inverse * inverse);
  }
  const double w = weight * time / kPlaces, c = curvature * time / kPlaces;
  // The inner Bernstein coefficients of b stay positive, relative to b at the nodes, and below the
  // ceiling.
  for (size_t i = 0; i < kInner.size(); ++i) {
    const Four& v = kInner[i];
    const double inner = dot(v, x), below = 1.0 / inner, above = 1.0 / (cell.most(i) - inner);
    terms.add(v, w * (ceiling_weight_ * above - below),
              c * (ceiling_weight_ * above * above + below * below));
  }
  terms.gradient[0] += w / x[0];
  terms.gradient[2] += w / x[2];
  if (cell.straight()) {
    assemble_straight(k + 1, x, w, c, terms);
  } else {
    assemble_curved(cell, x, w, c, terms);
  }
  for (size_t r = cell.first_cone; r < cell.last_cone; ++r) {
    CellCone& cone = cell_cones_[r];
    const double per_room = 1.0 / cell.factor.acceleration;
    cone.y = per_room * dot(cone.along, x);
    cone.n = per_room * dot(cone.across, x);
    cone.inverse = 1.0 / (1.0 - cone.y * cone.y - cone.n * cone.n);
    const double first = 2.0 * cone.inverse;
    Four along, across, half;  // slopes of both parts, and half of that of |y|²
    for (size_t i = 0; i < 4; ++i) {
      along[i] = per_room * cone.along[i];
      across[i] = per_room * cone.across[i];
      half[i] = cone.y * along[i] + cone.n * across[i];
    }
    terms.add(along, w * first * cone.y, c * first);
    terms.add(across, w * first * cone.n, c * first);
    terms.add(half, 0.0, c * first * first);
  }
  newton.add(k, terms, cell.length, cell.gear);
  return time;
}

// In both y = g √b / j is what a row of jerk uses of its limit, and yb, ys, yk are its slopes by b,
// h b', h² b''.
void BarrierProblem::assemble_straight(size_t index, const Four& x, double weight, double curvature,
                                       CellTerms& terms) {
  const CellRows& cell = cells_[index];
  StraightUse& use = straight_use_[index];
  const auto add = [&](size_t row, double y, const Four& slope) {
    const double inverse = 1.0 / (1.0 - y * y);
    use.y[row] = y;
    use.inverse[row] = inverse;
    terms.add(slope, weight * 2.0 * y * inverse,
              curvature * 2.0 * (1.0 + y * y) * inverse * inverse);
  };
  for (size_t row = 0; row < kStraightPlaces.size(); ++row) {
    const Place& place = kStraightPlaces[row];
    const double b = dot(place.value, x);
    const double yk = cell.straight_jerk * std::sqrt(b) / cell.factor.jerk;
    const double y = yk * dot(place.bend, x), yb = 0.5 * y / b;
    Four slope;
    for (size_t i = 0; i < 4; ++i) slope[i] = yb * place.value[i] + yk * place.bend[i];
    add(row, y, slope);
  }
  const double ys = cell.straight_acceleration / cell.factor.acceleration;
  Four slope;
  for (size_t i = 0; i < 4; ++i) slope[i] = ys * kMiddle.slope[i];
  add(kStraightPlaces.size(), dot(slope, x), slope);
}

void BarrierProblem::assemble_curved(const CellRows& cell, const Four& x, double weight,
                                     double curvature, CellTerms& terms) {
  const size_t pairs = cell.pairs();
  size_t row = cell.begin;
  for (const Place& place : kCurvedPlaces) {
    const double b = dot(place.value, x), slope = dot(place.slope, x), bend = dot(place.bend, x);
    const double root = std::sqrt(b) / cell.factor.jerk, half = 0.5 / b;
    Pair gb = Pair::Zero(), gs = gb, gk = gb;
    Pair hbb = gb, hbs = gb, hbk = gb, hss = gb, hsk = gb, hkk = gb;
    for (const size_t end = row + pairs; row < end; ++row) {
      const JerkRows& rows = jerk_rows_[row];
      const Pair yk = root * rows.bend, ys = root * rows.slope;
      const Pair y = (root * b) * rows.b + slope * ys + bend * yk;
      const Pair yb = root * rows.b + half * y;
      const Pair inverse = 1.0 / (1.0 - y * y);
      jerk_use_[row] = {y, inverse};
      const Pair first = 2.0 * y * inverse;
      const Pair second = 2.0 * (1.0 + y * y) * inverse * inverse;
      gb += first * yb;
      gs += first * ys;
      gk += first * yk;
      const Pair sb = second * yb, ss = second * ys;
      hbb += sb * yb;
      hbs += sb * ys;
      hbk += sb * yk;
      hss += ss * ys;
      hsk += ss * yk;
      hkk += second * yk * yk;
    }
    // Together as v mᵀ + m vᵀ for v = value, slope, bend.
    Four mb, ms, mk;
    const double bb = 0.5 * curvature * hbb.sum(), bs = curvature * hbs.sum(),
                 bk = curvature * hbk.sum();
    const double ss = 0.5 * curvature * hss.sum(), sk = curvature * hsk.sum(),
                 kk = 0.5 * curvature * hkk.sum();
    const double wb = weight * gb.sum(), ws = weight * gs.sum(), wk = weight * gk.sum();
    for (size_t i = 0; i < 4; ++i) {
      mb[i] = bb * place.value[i] + bs * place.slope[i] + bk * place.bend[i];
      ms[i] = ss * place.slope[i] + sk * place.bend[i];
      mk[i] = kk * place.bend[i];
      terms.gradient[i] += wb * place.value[i] + ws * place.slope[i] + wk * place.bend[i];
    }
    terms.add_symmetric(place.value, mb);
    terms.add_symmetric(place.slope, ms);
    terms.add_symmetric(place.bend, mk);
  }
  // Acceleration in the middle.
  const double per_room = 1.0 / cell.factor.acceleration;
  const double b = dot(kMiddle.value, x), slope = dot(kMiddle.slope, x);
  Pair gb = Pair::Zero(), gs = gb, hbb = gb, hbs = gb, hss = gb;
  for (size_t r = cell.middle; r < cell.middle + pairs; ++r) {
    const Pair yb = per_room * middle_rows_[r].b, ys = per_room * middle_rows_[r].slope;
    const Pair y = b * yb + slope * ys;
    const Pair inverse = 1.0 / (1.0 - y * y);
    middle_use_[r] = {y, inverse};
    const Pair first = 2.0 * y * inverse, second = 2.0 * (1.0 + y * y) * inverse * inverse;
    gb += first * yb;
    gs += first * ys;
    hbb += second * yb * yb;
    hbs += second * yb * ys;
    hss += second * ys * ys;
  }
  const double bb = 0.5 * curvature * hbb.sum(), bs = curvature * hbs.sum();
  const double ss = 0.5 * curvature * hss.sum();
  const double wb = weight * gb.sum(), ws = weight * gs.sum();
  Four mb, ms;
  for (size_t i = 0; i < 4; ++i) {
    mb[i] = bb * kMiddle.value[i] + bs * kMiddle.slope[i];
    ms[i] = ss * kMiddle.slope[i];
    terms.gradient[i] += wb * kMiddle.value[i] + ws * kMiddle.slope[i];
  }
  terms.add_symmetric(kMiddle.value, mb);
  terms.add_symmetric(kMiddle.slope, ms);
}

void BarrierProblem::assemble_node(size_t k, const NodeRate& rate, double weight, double curvature,
                                   NewtonSystem& newton) {
  const Node& node = nodes_[k];
  const double above = 1.0 / (node.most - rate.value), per_room = 1.0 / node.room;
  Pair gb = Pair::Zero(), gs = gb, bb = gb, bs = gb, ss = gb;
  for (size_t r = node.begin; r < node.end; ++r) {
    const AccelerationRows& rows = acceleration_rows_[r];
    const Pair yb = per_room * rows.b, ys = per_room * rows.slope;
    const Pair y = rate.value * yb + rate.slope * ys;
    const Pair inverse = 1.0 / (1.0 - y * y);
    acceleration_use_[r] = {y, inverse};
    const Pair first = 2.0 * y * inverse, second = 2.0 * (1.0 + y * y) * inverse * inverse;
    gb += first * yb;
    gs += first * ys;
    bb += second * yb * yb;
    bs += second * yb * ys;
    ss += second * ys * ys;
  }
  newton.add(k, weight * (ceiling_weight_ * above + gb.sum()), weight * gs.sum(),
             curvature * (ceiling_weight_ * above * above + bb.sum()), curvature * bs.sum(),
             curvature * ss.sum());
  for (size_t r = node.first_cone; r < node.last_cone; ++r) {
    ConeRow& cone = cones_[r];
    const double yb = per_room * cone.b, ys = per_room * cone.slope, nb = per_room * cone.normal;
    cone.y = rate.value * yb + rate.slope * ys;
    cone.across = rate.value * nb;
    cone.inverse = 1.0 / (1.0 - cone.y * cone.y - cone.across * cone.across);
    // Half the slopes of |y|².
    const double hb = cone.y * yb + cone.across * nb, hs = cone.y * ys;
    const double first = 2.0 * cone.inverse, second = first * first;
    newton.add(k, weight * first * hb, weight * first * hs,
               curvature * (first * (yb * yb + nb * nb) + second * hb * hb),
               curvature * (first * yb * ys + second * hb * hs),
               curvature * (first * ys * ys + second * hs * hs));
  }
}

double BarrierProblem::largest_step(const SquareRate& rate, const SquareRate& step) const {
  // The largest rate at which a slack is used up, per unit of step.
  double worst = 0.0;
  Pair worst_pair = Pair::Zero();
  const auto consider_cone = [&](double y, double n, double inverse, double along, double across) {
    // |y + t dy| = 1 for the least t > 0.
    const double half = y * along + n * across;
    const double square = along * along + across * across;
    worst = std::max(worst, (half + std::sqrt(half * half + square / inverse)) * inverse);
  };
  const auto consider = [&](const Use& use, const Pair& change, double room) {
    worst_pair = worst_pair.max((change - room) * (1.0 + use.y) * use.inverse)
                     .max((-change - room) * (1.0 - use.y) * use.inverse);
  };
  for (size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    const double db = step[k].value, ds = step[k].slope, b = rate[k].value;
    worst = std::max({worst, db / (node.most - b), -db / b});
    const double per_room = 1.0 / node.room;
    for (size_t r = node.begin; r < node.end; ++r) {
      const AccelerationRows& rows = acceleration_rows_[r];
      consider(acceleration_use_[r], (per_room * db) * rows.b + (per_room * ds) * rows.slope, 0.0);
    }
    for (size_t r = node.first_cone; r < node.last_cone; ++r) {
      const ConeRow& cone = cones_[r];
      const double along = per_room * (db * cone.b + ds * cone.slope);
      const double across = per_room * db * cone.normal;
      consider_cone(cone.y, cone.across, cone.inverse, along, across);
    }
    if (k + 1 == nodes_.size()) break;
    const CellRows& cell = cells_[k + 1];
    const Four x = cell.numbers(rate[k], rate[k + 1]);
    const Four dx = cell.numbers(step[k], step[k + 1]);
    for (size_t r = cell.first_cone; r < cell.last_cone; ++r) {
      const CellCone& cone = cell_cones_[r];
      const double room = 1.0 / cell.factor.acceleration;
      consider_cone(cone.y, cone.n, cone.inverse, room * dot(cone.along, dx),
                    room * dot(cone.across, dx));
    }
    for (size_t i = 0; i < kInner.size(); ++i) {
      const double inner = dot(kInner[i], x), change = dot(kInner[i], dx);
      worst = std::max({worst, change / (cell.most(i) - inner), -change / inner});
    }
    if (cell.straight()) {
      const StraightUse& use = straight_use_[k + 1];
      const auto take = [&](size_t row, double change, double room) {
        worst = std::max({worst, (change - room) * (1.0 + use.y[row]) * use.inverse[row],
                          (-change - room) * (1.0 - use.y[row]) * use.inverse[row]});
      };
      for (size_t row = 0; row < kStraightPlaces.size(); ++row) {
        const Place& place = kStraightPlaces[row];
        const double b_here = dot(place.value, x), db_here = dot(place.value, dx);
        const double yk = cell.straight_jerk * std::sqrt(b_here) / cell.factor.jerk;
        worst = std::max(worst, -db_here / b_here);
        take(row, yk * dot(place.bend, dx), -0.5 * db_here / b_here);
      }
      const double ys = cell.straight_acceleration / cell.factor.acceleration;
      take(kStraightPlaces.size(), ys * dot(kMiddle.slope, dx), 0.0);
      continue;
    }
    const size_t pairs = cell.pairs();
    size_t row = cell.begin;
    for (const Place& place : kCurvedPlaces) {
      const double at = dot(place.value, x), dat = dot(place.value, dx);
      const double root = std::sqrt(at) / cell.factor.jerk;
      const double change = root * dat, slope = root * dot(place.slope, dx);
      const double bend = root * dot(place.bend, dx), room = -0.5 * dat / at;
      worst = std::max(worst, -dat / at);
      for (const size_t end = row + pairs; row < end; ++row) {
        const JerkRows& rows = jerk_rows_[row];
        consider(jerk_use_[row], change * rows.b + slope * rows.slope + bend * rows.bend, room);
      }
    }
    const double per_room_here = 1.0 / cell.factor.acceleration;
    const double change = per_room_here * dot(kMiddle.value, dx);
    const double slope = per_room_here * dot(kMiddle.slope, dx);
    for (size_t r = cell.middle; r < cell.middle + pairs; ++r) {
      consider(middle_use_[r], change * middle_rows_[r].b + slope * middle_rows_[r].slope, 0.0);
    }
  }
  worst = std::max(worst, worst_pair.maxCoeff());
  return worst > 0.0 ? 1.0 / worst : kInfinite;
}

bool BarrierProblem::solve(SquareRate& rate, double from, double weight) {
  constexpr int kMostSteps = 200, kMany = 7;
  constexpr double kStillFar = 10.0, kSlowly = 0.97;
  constexpr double kBoundary = 0.95;
  double before = kInfinite;
  NewtonSystem newton(nodes_.size());
  SquareRate step(nodes_.size());
  // A slack near its end holds weight / multiplier. The multipliers are those of the weight that
  // was come from, and so is the curvature: with it a step leads to the new slack, not past it.
  // Both fall as far as steps go (that is the primal-dual direction).
  double curvature = from;
  for (int k = 1; k <= kMostSteps; ++k) {
    const double time = assemble(rate, weight, curvature, newton);
    double decrement = 0.0;
    if (!newton.solve(step, decrement)) return false;
    const double length = std::min(1.0, kBoundary * largest_step(rate, step));
    if (!std::isfinite(decrement) || !(length > 0.0)) return false;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      rate[i].value += length * step[i].value;
      rate[i].slope += length * step[i].slope;
    }
    // One tight place shortens the step of the whole section: wait for it, but not for long.
    const double distance = decrement / (weight * time);
    if (distance <= 1.0 && length > 0.5) return true;
    if (distance <= kStillFar && k >= kMany && time > kSlowly * before) return true;
    before = time;
    curvature = weight + (1.0 - length) * (curvature - weight);
  }
  return true;
}

}  // namespace viapoint::path_timing
