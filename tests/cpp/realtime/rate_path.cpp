#include "realtime/rate_path.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint {
namespace {

/// Rate and derivatives over one cycle: τ = τ0 + ρ0 t + α0 t²/2 + γ t³/6.
struct Cubic {
  double tau, rate, slope, curvature;
};

Cubic between(const LogRecord& a, const LogRecord& b, double cycle) {
  const double advance = b.nominal_time - a.nominal_time - a.rate * cycle;
  const double change = b.rate - a.rate;
  Cubic cubic{a.nominal_time, a.rate, 0.0, 0.0};
  if (a.rate == b.rate && std::abs(advance) < 1e-12) return cubic;
  cubic.curvature = 12.0 * (0.5 * change * cycle - advance) / (cycle * cycle * cycle);
  cubic.slope = change / cycle - 0.5 * cubic.curvature * cycle;
  return cubic;
}

/// Whether a piece begins there, or the motion ends, at rest.
bool begins_at_rest(const Trajectory& motion, double tau) {
  constexpr double kSlack = 1e-9;
  const JointState path = motion.at(tau);
  if (path.qd.norm() > kSlack || path.qdd.norm() > kSlack) return false;
  const std::size_t piece = motion.piece_at(tau);
  const double begin = motion.start_of(piece), end = begin + motion.pieces()[piece].duration;
  return std::min(std::abs(tau - begin), std::abs(tau - end)) < kSlack;
}

}  // namespace

double Shares::worst() const { return std::max({velocity, acceleration, jerk}); }

Shares worst_shares(const Motion& motion, std::span<const LogRecord> log, double cycle,
                    int samples) {
  Shares shares;
  for (std::size_t k = 0; k + 1 < log.size(); ++k) {
    // At its very start the motion rests, and may take any rate at once; in its last cycle it ends
    // before the cycle does.
    if (log[k].nominal_time == 0.0 && log[k].rate != log[k + 1].rate) continue;
    if (log[k + 1].nominal_time >= motion.trajectory.duration()) continue;
    // So it does where a step, a stop, or the way back, ends at a point at which the path rests,
    // and from there it goes on at any rate.
    if (begins_at_rest(motion.trajectory, log[k + 1].nominal_time)) continue;
    const Cubic c = between(log[k], log[k + 1], cycle);
    for (int s = 0; s < samples; ++s) {
      const double t = cycle * (s + 0.5) / samples;
      const double tau = c.tau + t * (c.rate + t * (0.5 * c.slope + t * c.curvature / 6.0));
      const double rate = c.rate + t * (c.slope + 0.5 * t * c.curvature);
      const double slope = c.slope + t * c.curvature;
      const JointState p = motion.trajectory.at(tau);
      for (int i = 0; i < motion.limits.joints(); ++i) {
        const double v = std::abs(p.qd[i] * rate) / motion.limits.velocity[i];
        const double a =
            std::abs(p.qdd[i] * rate * rate + p.qd[i] * slope) / motion.limits.acceleration[i];
        const double j = std::abs(p.qddd[i] * rate * rate * rate + 3.0 * p.qdd[i] * rate * slope +
                                  p.qd[i] * c.curvature) /
                         motion.limits.jerk[i];
        if (std::max({v, a, j}) > shares.worst()) shares.cycle = k;
        shares.velocity = std::max(shares.velocity, v);
        shares.acceleration = std::max(shares.acceleration, a);
        shares.jerk = std::max(shares.jerk, j);
      }
    }
  }
  return shares;
}

}  // namespace viapoint
