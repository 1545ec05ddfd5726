#include "trajectory/path_timing_newton.hpp"

#include <cmath>

namespace viapoint::path_timing {

bool NewtonSystem::solve(SquareRate& step) const {
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

}  // namespace viapoint::path_timing
