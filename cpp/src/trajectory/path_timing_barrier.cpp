#include "trajectory/path_timing_barrier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trajectory/path_timing_newton.hpp"

namespace viapoint::path_timing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Quadrature {
  double at, weight;
};
/// Gauss–Legendre on [0, 1].
constexpr std::array<Quadrature, 3> kGauss3{
    {{0.1127016653792583, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.8872983346207417, 5.0 / 18.0}}};
constexpr std::array<Quadrature, 5> kGauss5{{{0.046910077030668, 0.1184634425280945},
                                             {0.2307653449471585, 0.2393143352496832},
                                             {0.5, 0.2844444444444444},
                                             {0.7692346550528415, 0.2393143352496832},
                                             {0.953089922969332, 0.1184634425280945}}};

}  // namespace

SquareRate BarrierProblem::start() const {
  const size_t n = nodes_.size();
  SquareRate rate{grid_.square_rate, std::vector<double>(n)};
  // Slopes by the harmonic mean of the neighbours' (Fritsch & Butland 1984): the cubic is monotone
  // between nodes and so stays positive.
  for (size_t k = 0; k < n; ++k) {
    if (k == 0 || k + 1 == n) {
      rate.slope[k] = (k == 0 ? start_tie() : end_tie()) * rate.value[k];
      continue;
    }
    const double before = (rate.value[k] - rate.value[k - 1]) / cells_[k].length;
    const double after = (rate.value[k + 1] - rate.value[k]) / cells_[k + 1].length;
    rate.slope[k] = before * after > 0.0 ? 2.0 * before * after / (before + after) : 0.0;
  }
  constexpr int kRounds = 4;
  make_feasible(rate, kRounds);
  return rate;
}

std::vector<Shares> BarrierProblem::shares(const SquareRate& rate) const {
  std::vector<Shares> shares(cells_.size());
  for (size_t k = 0; k < nodes_.size(); ++k) {
    const double b = rate.value[k];
    Shares here;
    here.velocity = std::sqrt(b / nodes_[k].ceiling);
    for (size_t r = nodes_[k].acceleration.begin; r < nodes_[k].acceleration.end; ++r) {
      const AccelerationRow& row = acceleration_rows_[r];
      here.acceleration =
          std::max(here.acceleration, std::abs(row.b * b + row.slope * rate.slope[k]));
    }
    shares[k].include(here);
    shares[k + 1].include(here);
  }
  for (size_t k = 1; k + 1 < cells_.size(); ++k) {
    const CellRows& cell = cells_[k];
    const Four x{rate.value[k - 1], rate.slope[k - 1], rate.value[k], rate.slope[k]};
    for (size_t p = 0; p < cell.count; ++p) {
      const Place& place = cell.places[p];
      const double b = dot(place.value, x), slope = dot(place.slope, x), bend = dot(place.bend, x);
      for (size_t r = place.rows.begin; r < place.rows.end; ++r) {
        const JerkRow& row = jerk_rows_[r];
        const double share =
            std::abs(row.b * b + row.slope * slope + row.bend * bend) * std::sqrt(b);
        shares[k].jerk = std::max(shares[k].jerk, share);
      }
    }
  }
  const double start = rate.value.front() / start_ceiling_;
  const double end = rate.value.back() / end_ceiling_;
  shares.front().jerk = start * std::sqrt(start);
  shares.back().jerk = end * std::sqrt(end);
  return shares;
}

void BarrierProblem::make_feasible(SquareRate& rate, int rounds) const {
  constexpr double kRoom = 0.95;
  const size_t n = nodes_.size();
  std::vector<double> scale(n);
  for (int round = 0;; ++round) {
    const std::vector<Shares> used = shares(rate);
    const auto excess = [&](size_t k) {  // of ṡ in a cell
      const CellRows& cell = cells_[k];
      return std::max({used[k].velocity / cell.velocity,
                       std::sqrt(used[k].acceleration / cell.acceleration),
                       std::cbrt(used[k].jerk / cell.jerk)});
    };
    double worst = 0.0;
    for (size_t k = 0; k < n; ++k) {
      scale[k] = std::max(excess(k), excess(k + 1)) / kRoom;
      worst = std::max(worst, scale[k]);
    }
    if (worst <= 1.0) return;
    if (round == rounds) {
      for (size_t k = 0; k < n; ++k) {
        rate.value[k] /= worst * worst;
        rate.slope[k] /= worst * worst;
      }
      return;
    }
    // Slower where it must be, less and less so further away, that b'' stays small.
    constexpr double kFade = 0.7;
    for (double& value : scale) value = std::max(0.0, std::log(value));
    for (size_t k = 1; k < n; ++k) scale[k] = std::max(scale[k], kFade * scale[k - 1]);
    for (size_t k = n - 1; k-- > 0;) scale[k] = std::max(scale[k], kFade * scale[k + 1]);
    for (size_t k = 0; k < n; ++k) {
      const size_t before = k == 0 ? 0 : k - 1, after = std::min(k + 1, n - 1);
      double distance = 0.0;
      for (size_t m = before; m < after; ++m) distance += cells_[m + 1].length;
      const double bend = -2.0 * (scale[after] - scale[before]) / distance;
      const double factor = std::exp(-2.0 * scale[k]);
      rate.slope[k] = factor * (rate.slope[k] + bend * rate.value[k]);
      rate.value[k] *= factor;
    }
    // The cubic stays positive: its Bernstein coefficients do.
    constexpr double kSteepest = 2.5;
    for (size_t k = 1; k + 1 < n; ++k) {
      rate.slope[k] = std::clamp(rate.slope[k], -kSteepest * rate.value[k] / cells_[k + 1].length,
                                 kSteepest * rate.value[k] / cells_[k].length);
    }
    rate.slope.front() = start_tie() * rate.value.front();
    rate.slope.back() = end_tie() * rate.value.back();
  }
}

void BarrierProblem::scale_limits(const std::vector<Shares>& factors) {
  for (size_t k = 0; k < cells_.size(); ++k) {
    cells_[k].velocity *= factors[k].velocity;
    cells_[k].acceleration *= factors[k].acceleration;
    cells_[k].jerk *= factors[k].jerk;
  }
}

void BarrierProblem::assemble(const SquareRate& rate, double weight, double curvature,
                              NewtonSystem& newton) const {
  newton.clear();
  const size_t n = nodes_.size();
  double before = 0.0;  // time in the cell before the node
  for (size_t k = 0; k < n; ++k) {
    // The cell after node k; after the last node the ramp to rest.
    const CellRows& cell = cells_[k + 1];
    const double h = cell.length;
    const double b = rate.value[k];
    double time = 0.0;
    if (k + 1 < n) {
      const Four x{b, rate.slope[k], rate.value[k + 1], rate.slope[k + 1]};
      for (const Quadrature& q : kGauss3) {
        const Four v = basis(q.at, h);
        const double inverse = 1.0 / dot(v, x);
        const double f = q.weight * h * std::sqrt(inverse);
        time += f;
        newton.add(k, v, -0.5 * f * inverse, 0.75 * f * inverse * inverse);
      }
      const double share = time / static_cast<double>(cell.count);
      const double w = weight * share, c = curvature * share;
      // The inner Bernstein coefficients of b stay positive, relative to b at the nodes.
      for (const int side : {0, 1}) {
        const double value = x[side == 0 ? 0 : 2];
        const double inverse = 1.0 / (value + (side == 0 ? h : -h) / 3.0 * x[side == 0 ? 1 : 3]);
        const Four v = side == 0 ? Four{1.0, h / 3.0, 0.0, 0.0} : Four{0.0, 0.0, 1.0, -h / 3.0};
        newton.add(k, v, -w * inverse, c * inverse * inverse);
        newton.gradient_b[side == 0 ? k : k + 1] += w / value;
      }
      for (size_t p = 0; p < cell.count; ++p) {
        const Place& place = cell.places[p];
        const double at = dot(place.value, x), slope = dot(place.slope, x);
        const double bend = dot(place.bend, x);
        // y = g √b / j, and its derivatives by b, b', b''.
        const double root = std::sqrt(at) / cell.jerk, half = 0.5 / at;
        double gb = 0, gs = 0, gk = 0, hbb = 0, hbs = 0, hbk = 0, hss = 0, hsk = 0, hkk = 0;
        for (size_t r = place.rows.begin; r < place.rows.end; ++r) {
          const JerkRow& row = jerk_rows_[r];
          const double y = root * (row.b * at + row.slope * slope + row.bend * bend);
          const double above = 1.0 / (1.0 - y), below = 1.0 / (1.0 + y);
          newton.jerk_above[r] = above;
          newton.jerk_below[r] = below;
          const double yb = root * row.b + half * y, ys = root * row.slope, yk = root * row.bend;
          const double first = above - below, second = above * above + below * below;
          gb += first * yb;
          gs += first * ys;
          gk += first * yk;
          hbb += second * yb * yb;
          hbs += second * yb * ys;
          hbk += second * yb * yk;
          hss += second * ys * ys;
          hsk += second * ys * yk;
          hkk += second * yk * yk;
        }
        newton.add(k, place.value, w * gb, c * hbb);
        newton.add(k, place.slope, w * gs, c * hss);
        newton.add(k, place.bend, w * gk, c * hkk);
        newton.add_mixed(k, place.value, place.slope, c * hbs);
        newton.add_mixed(k, place.value, place.bend, c * hbk);
        newton.add_mixed(k, place.slope, place.bend, c * hsk);
      }
    }
    double ceiling = nodes_[k].ceiling * std::min(cells_[k].velocity, cell.velocity) *
                     std::min(cells_[k].velocity, cell.velocity);
    const auto ramp = [&](double length, double most, const CellRows& factors) {
      time = 3.0 * length / std::sqrt(b);
      newton.gradient_b[k] -= 0.5 * time / b;
      newton.diagonal[k].bb += 0.75 * time / (b * b);
      ceiling = std::min(ceiling, most * std::cbrt(factors.jerk * factors.jerk));
      return time;
    };
    if (k == 0) {
      const double inner = time;
      before = ramp(cells_.front().length, start_ceiling_, cells_.front());
      newton.objective += before;
      time = inner;
    }
    if (k + 1 == n) ramp(h, end_ceiling_, cell);
    newton.objective += time;
    const double w = 0.5 * weight * (before + time), c = 0.5 * curvature * (before + time);
    const double above = 1.0 / (ceiling - b);
    newton.gradient_b[k] += w * above;
    newton.diagonal[k].bb += c * above * above;
    const double room = std::min(cells_[k].acceleration, cell.acceleration);
    for (size_t r = nodes_[k].acceleration.begin; r < nodes_[k].acceleration.end; ++r) {
      const AccelerationRow& row = acceleration_rows_[r];
      const double g = row.b * b + row.slope * rate.slope[k];
      const double over = 1.0 / (room - g), under = 1.0 / (room + g);
      newton.acceleration_above[r] = over;
      newton.acceleration_below[r] = under;
      const double first = w * (over - under), second = c * (over * over + under * under);
      newton.gradient_b[k] += first * row.b;
      newton.gradient_s[k] += first * row.slope;
      newton.diagonal[k].bb += second * row.b * row.b;
      newton.diagonal[k].bs += second * row.b * row.slope;
      newton.diagonal[k].ss += second * row.slope * row.slope;
    }
    before = time;
  }
  newton.tie_ends(start_tie(), end_tie());
}

double BarrierProblem::largest_step(const SquareRate& rate, const SquareRate& step,
                                    const NewtonSystem& newton) const {
  // The largest rate at which a slack is used up, per unit of step.
  double worst = 0.0;
  const size_t n = nodes_.size();
  for (size_t k = 0; k < n; ++k) {
    const CellRows& cell = cells_[k + 1];
    const double db = step.value[k], ds = step.slope[k], b = rate.value[k];
    const double factor = std::min(cells_[k].velocity, cell.velocity);
    double ceiling = nodes_[k].ceiling * factor * factor;
    if (k == 0) {
      const double f = cells_.front().jerk;
      ceiling = std::min(ceiling, start_ceiling_ * std::cbrt(f * f));
    }
    if (k + 1 == n) ceiling = std::min(ceiling, end_ceiling_ * std::cbrt(cell.jerk * cell.jerk));
    worst = std::max({worst, db / (ceiling - b), -db / b});
    for (size_t r = nodes_[k].acceleration.begin; r < nodes_[k].acceleration.end; ++r) {
      const double g = acceleration_rows_[r].b * db + acceleration_rows_[r].slope * ds;
      worst =
          std::max({worst, g * newton.acceleration_above[r], -g * newton.acceleration_below[r]});
    }
    if (k + 1 == n) break;
    const Four x{b, rate.slope[k], rate.value[k + 1], rate.slope[k + 1]};
    const Four dx{db, ds, step.value[k + 1], step.slope[k + 1]};
    const double third = cell.length / 3.0;
    worst = std::max({worst, -(dx[0] + third * dx[1]) / (x[0] + third * x[1]),
                      -(dx[2] - third * dx[3]) / (x[2] - third * x[3])});
    for (size_t p = 0; p < cell.count; ++p) {
      const Place& place = cell.places[p];
      const double at = dot(place.value, x), dat = dot(place.value, dx);
      const double dslope = dot(place.slope, dx), dbend = dot(place.bend, dx);
      const double root = std::sqrt(at) / cell.jerk, droom = -0.5 * dat / at;
      worst = std::max(worst, -dat / at);
      for (size_t r = place.rows.begin; r < place.rows.end; ++r) {
        const JerkRow& row = jerk_rows_[r];
        const double g = root * (row.b * dat + row.slope * dslope + row.bend * dbend);
        worst = std::max(
            {worst, (g - droom) * newton.jerk_above[r], -(g + droom) * newton.jerk_below[r]});
      }
    }
  }
  return worst > 0.0 ? 1.0 / worst : kInfinite;
}

bool BarrierProblem::solve(SquareRate& rate, double weight, double last_weight) const {
  constexpr double kReduction = 0.2;
  constexpr int kMostSteps = 200, kMostAtOneWeight = 7;
  constexpr double kStillFar = 10.0, kSlowly = 0.97;
  double before = kInfinite;
  constexpr double kBoundary = 0.95;
  const size_t n = nodes_.size();
  NewtonSystem newton(n, acceleration_rows_.size(), jerk_rows_.size());
  SquareRate step{std::vector<double>(n), std::vector<double>(n)};
  double curvature = weight;
  int at_this_weight = 0;
  for (int k = 0; k < kMostSteps; ++k) {
    assemble(rate, weight, curvature, newton);
    if (!newton.solve(step)) return false;
    step.slope.front() = start_tie() * step.value.front();
    step.slope.back() = end_tie() * step.value.back();
    double decrement = 0.0;
    for (size_t i = 0; i < n; ++i) {
      decrement -= newton.gradient_b[i] * step.value[i] + newton.gradient_s[i] * step.slope[i];
    }
    const double most = largest_step(rate, step, newton);
    const double length = std::min(1.0, kBoundary * most);
    if (!std::isfinite(decrement) || !(length > 0.0)) return false;
    for (size_t i = 0; i < n; ++i) {
      rate.value[i] += length * step.value[i];
      rate.slope[i] += length * step.slope[i];
    }
    // One tight place shortens the step of the whole section: wait for it, but not for long.
    const double distance = decrement / (weight * newton.objective);
    ++at_this_weight;
    const bool central = (distance <= 1.0 && length > 0.5) ||
                         (distance <= kStillFar && at_this_weight >= kMostAtOneWeight &&
                          newton.objective > kSlowly * before);
    before = newton.objective;
    // A slack near its end holds weight / multiplier. Right after a reduction the multiplier is
    // that of the old weight, and so is the curvature: with it the step leads to the new slack, not
    // past it (that is the primal-dual direction).
    curvature = weight;
    if (!central) continue;
    if (weight <= last_weight) return true;
    weight = std::max(last_weight, weight * kReduction);
    at_this_weight = 0;
  }
  return true;
}

std::vector<TimedSpan> BarrierProblem::spans(const SquareRate& rate) const {
  std::vector<TimedSpan> spans;
  const auto state = [&](size_t node, double s) {
    return RateState{s, std::sqrt(rate.value[node]), 0.5 * rate.slope[node]};
  };
  for (size_t k = 0; k < cells_.size(); ++k) {
    const Cell& cell = grid_.cells[k];
    const double length = path_->pieces()[cell.piece].length;
    const RateState from = k == 0 ? RateState{cell.s0, 0.0, 0.0} : state(k - 1, cell.s0);
    const RateState to = k + 1 == cells_.size() ? RateState{cell.s1, 0.0, 0.0} : state(k, cell.s1);
    double time = 0.0;
    if (k == 0) {
      time = 3.0 * cells_[k].length / to.rate;
    } else if (k + 1 == cells_.size()) {
      time = 3.0 * cells_[k].length / from.rate;
    } else {
      const Four x{rate.value[k - 1], rate.slope[k - 1], rate.value[k], rate.slope[k]};
      for (const Quadrature& q : kGauss5) {
        time += q.weight * cells_[k].length / std::sqrt(dot(basis(q.at, cells_[k].length), x));
      }
    }
    spans.push_back(TimedSpan::between(cell.piece, length, from, to, time));
  }
  return spans;
}

}  // namespace viapoint::path_timing
