#include "trajectory/path_timing_barrier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viapoint::path_timing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Derivatives by (b0, b0', b1, b1').
using Four = std::array<double, 4>;

double dot(const Four& a, const Four& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/// Cubic Hermite basis at share x of a cell.
Four basis(double x, double h) {
  const double x2 = x * x, x3 = x2 * x;
  return {1 - 3 * x2 + 2 * x3, h * (x - 2 * x2 + x3), 3 * x2 - 2 * x3, h * (x3 - x2)};
}

/// Its first and second derivatives by s.
Four basis_slope(double x, double h) {
  const double x2 = x * x;
  return {(6 * x2 - 6 * x) / h, 1 - 4 * x + 3 * x2, (6 * x - 6 * x2) / h, 3 * x2 - 2 * x};
}
Four basis_bend(double x, double h) {
  const double h2 = h * h;
  return {(12 * x - 6) / h2, (6 * x - 4) / h, (6 - 12 * x) / h2, (6 * x - 2) / h};
}

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

/// Gradient and block tridiagonal Hessian, and what the step length needs.
struct BarrierProblem::Newton {
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

  explicit Newton(size_t nodes, size_t acceleration_rows, size_t jerk_rows)
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
  bool solve(SquareRate& step) {
    const size_t n = diagonal.size();
    // d = L Lᵀ of each 2x2 block; y the forward solution; link = L⁻¹ upper.
    std::vector<std::array<double, 3>> factor(n);
    std::vector<Link> link(n);
    for (size_t k = 0; k < n; ++k) {
      Block d = diagonal[k];
      double gb = -gradient_b[k], gs = -gradient_s[k];
      if (k > 0) {
        const Link& l = link[k - 1];
        d.bb -= l.bb * l.bb + l.sb * l.sb;
        d.bs -= l.bb * l.bs + l.sb * l.ss;
        d.ss -= l.bs * l.bs + l.ss * l.ss;
        gb -= l.bb * step.value[k - 1] + l.sb * step.slope[k - 1];
        gs -= l.bs * step.value[k - 1] + l.ss * step.slope[k - 1];
      }
      if (!(d.bb > 0.0)) return false;
      const double l11 = std::sqrt(d.bb);
      const double l21 = d.bs / l11;
      const double rest = d.ss - l21 * l21;
      if (!(rest > 0.0)) return false;
      const double l22 = std::sqrt(rest);
      factor[k] = {l11, l21, l22};
      step.value[k] = gb / l11;
      step.slope[k] = (gs - l21 * step.value[k]) / l22;
      const Link& u = upper[k];
      link[k].bb = u.bb / l11;
      link[k].bs = u.bs / l11;
      link[k].sb = (u.sb - l21 * link[k].bb) / l22;
      link[k].ss = (u.ss - l21 * link[k].bs) / l22;
    }
    for (size_t k = n; k-- > 0;) {
      double yb = step.value[k], ys = step.slope[k];
      if (k + 1 < n) {
        yb -= link[k].bb * step.value[k + 1] + link[k].bs * step.slope[k + 1];
        ys -= link[k].sb * step.value[k + 1] + link[k].ss * step.slope[k + 1];
      }
      step.slope[k] = ys / factor[k][2];
      step.value[k] = (yb - factor[k][1] * step.slope[k]) / factor[k][0];
    }
    return true;
  }
};

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
  double ceiling = kInfinite;
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
                              Newton& newton) const {
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
                                    const Newton& newton) const {
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
    for (const Quadrature& q : kGauss3) {
      const Four v = basis(q.at, cell.length);
      worst = std::max(worst, -dot(v, dx) / dot(v, x));
    }
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
  constexpr int kMostSteps = 100, kMostAtOneWeight = 5;
  constexpr double kStillFar = 10.0;
  constexpr double kBoundary = 0.95;
  const size_t n = nodes_.size();
  Newton newton(n, acceleration_rows_.size(), jerk_rows_.size());
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
                         (distance <= kStillFar && at_this_weight >= kMostAtOneWeight);
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
