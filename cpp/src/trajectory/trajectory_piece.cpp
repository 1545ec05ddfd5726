#include "viapoint/trajectory/trajectory_piece.hpp"

#include <cstddef>

namespace viapoint {
namespace {

/// u and its derivatives by τ.
struct Timing {
  double u, u1, u2, u3;
};

Timing timing_at(const TrajectoryPiece& piece, double tau) noexcept {
  const auto& c = piece.timing;
  const double per_second = 1.0 / piece.duration;
  const double x = tau * per_second;
  const double u = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  const double u1 = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5])));
  const double u2 = 2 * c[2] + x * (6 * c[3] + x * (12 * c[4] + x * 20 * c[5]));
  const double u3 = 6 * c[3] + x * (24 * c[4] + x * 60 * c[5]);
  return {u, u1 * per_second, u2 * per_second * per_second,
          u3 * per_second * per_second * per_second};
}

}  // namespace

TrajectoryPiece TrajectoryPiece::until(double tau) const noexcept {
  TrajectoryPiece part = *this;
  const double share = tau / duration;
  double power = 1.0;
  for (double& coefficient : part.timing) {
    coefficient *= power;
    power *= share;
  }
  part.duration = tau;
  return part;
}

TrajectoryPiece TrajectoryPiece::from(double tau) const noexcept {
  TrajectoryPiece part = *this;
  const double start = tau / duration;
  // Horner's rule, again and again: the Taylor coefficients there.
  for (std::size_t k = 0; k < 5; ++k) {
    for (std::size_t i = 5; i-- > k;) part.timing[i] += start * part.timing[i + 1];
  }
  part.outputs = 0;
  part.output = {};
  part.wait = {};
  double power = 1.0;
  for (double& coefficient : part.timing) {
    coefficient *= power;
    power *= 1.0 - start;
  }
  part.duration = duration - tau;
  return part;
}

JointState TrajectoryPiece::at(double tau) const noexcept {
  const auto [u, u1, u2, u3] = timing_at(*this, tau);
  JointState state;
  state.q.resize(joints);
  state.qd.resize(joints);
  state.qdd.resize(joints);
  state.qddd.resize(joints);
  for (int i = 0; i < joints; ++i) {
    const auto j = static_cast<std::size_t>(i);
    const double c1 = path[1][j], c2 = path[2][j], c3 = path[3][j], c4 = path[4][j],
                 c5 = path[5][j];
    const double p1 = c1 + u * (2 * c2 + u * (3 * c3 + u * (4 * c4 + u * 5 * c5)));
    const double p2 = 2 * c2 + u * (6 * c3 + u * (12 * c4 + u * 20 * c5));
    const double p3 = 6 * c3 + u * (24 * c4 + u * 60 * c5);
    state.q[i] = path[0][j] + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))));
    // Chain rule for q(u(τ)), third order (Faà di Bruno).
    state.qd[i] = p1 * u1;
    state.qdd[i] = p2 * u1 * u1 + p1 * u2;
    state.qddd[i] = p3 * u1 * u1 * u1 + 3 * p2 * u1 * u2 + p1 * u3;
  }
  return state;
}

}  // namespace viapoint
