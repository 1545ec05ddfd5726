#include "trajectory/path_timing_newton.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint::path_timing {

void NewtonSystem::clear() {
  std::ranges::fill(diagonal_, Block{});
  std::ranges::fill(upper_, Link{});
  std::ranges::fill(gradient_, NodeRate{});
}

void NewtonSystem::add(size_t k, const CellTerms& terms, double length, double gear) {
  // From the cell's numbers to those of the nodes.
  const double b0 = gear * gear, s0 = length * gear, s1 = length;
  const Four& g = terms.gradient;
  const auto& h = terms.hessian;
  gradient_[k].value += b0 * g[0];
  gradient_[k].slope += s0 * g[1];
  gradient_[k + 1].value += g[2];
  gradient_[k + 1].slope += s1 * g[3];
  Block& left = diagonal_[k];
  left.bb += b0 * b0 * h[0];
  left.bs += b0 * s0 * h[1];
  left.ss += s0 * s0 * h[4];
  upper_[k] = {b0 * h[2], b0 * s1 * h[3], s0 * h[5], s0 * s1 * h[6]};
  Block& right = diagonal_[k + 1];
  right.bb += h[7];
  right.bs += s1 * h[8];
  right.ss += s1 * s1 * h[9];
}

void NewtonSystem::tie_ends(double start, double end) {
  start_tie_ = start;
  end_tie_ = end;
  const auto tie = [this](size_t k, double t) {
    Block& d = diagonal_[k];
    d = {d.bb + 2 * t * d.bs + t * t * d.ss, 0.0, 1.0};
    gradient_[k].value += t * gradient_[k].slope;
    gradient_[k].slope = 0.0;
  };
  const size_t last = diagonal_.size() - 1;
  tie(0, start);
  Link& first = upper_[0];
  first = {first.bb + start * first.sb, first.bs + start * first.ss, 0.0, 0.0};
  tie(last, end);
  Link& before = upper_[last - 1];
  before = {before.bb + end * before.bs, 0.0, before.sb + end * before.ss, 0.0};
}

bool NewtonSystem::solve(SquareRate& step, double& decrement) {
  const size_t n = diagonal_.size();
  // Each 2x2 block becomes L Lᵀ with the reciprocals of L's diagonal kept, each link L⁻¹ upper; y,
  // the forward solution, has yᵀy = gᵀ H⁻¹ g.
  decrement = 0.0;
  for (size_t k = 0; k < n; ++k) {
    Block& d = diagonal_[k];
    double gb = -gradient_[k].value, gs = -gradient_[k].slope;
    if (k > 0) {
      const Link& l = upper_[k - 1];
      d.bb -= l.bb * l.bb + l.sb * l.sb;
      d.bs -= l.bb * l.bs + l.sb * l.ss;
      d.ss -= l.bs * l.bs + l.ss * l.ss;
      gb -= l.bb * step[k - 1].value + l.sb * step[k - 1].slope;
      gs -= l.bs * step[k - 1].value + l.ss * step[k - 1].slope;
    }
    if (!(d.bb > 0.0)) return false;
    const double r1 = 1.0 / std::sqrt(d.bb);
    const double l21 = d.bs * r1;
    const double rest = d.ss - l21 * l21;
    if (!(rest > 0.0)) return false;
    const double r2 = 1.0 / std::sqrt(rest);
    d = {r1, l21, r2};
    step[k].value = gb * r1;
    step[k].slope = (gs - l21 * step[k].value) * r2;
    decrement += step[k].value * step[k].value + step[k].slope * step[k].slope;
    Link& u = upper_[k];
    u.bb *= r1;
    u.bs *= r1;
    u.sb = (u.sb - l21 * u.bb) * r2;
    u.ss = (u.ss - l21 * u.bs) * r2;
  }
  for (size_t k = n; k-- > 0;) {
    double yb = step[k].value, ys = step[k].slope;
    if (k + 1 < n) {
      yb -= upper_[k].bb * step[k + 1].value + upper_[k].bs * step[k + 1].slope;
      ys -= upper_[k].sb * step[k + 1].value + upper_[k].ss * step[k + 1].slope;
    }
    const Block& d = diagonal_[k];
    step[k].slope = ys * d.ss;
    step[k].value = (yb - d.bs * step[k].slope) * d.bb;
  }
  step.front().slope = start_tie_ * step.front().value;
  step.back().slope = end_tie_ * step.back().value;
  return true;
}

}  // namespace viapoint::path_timing
