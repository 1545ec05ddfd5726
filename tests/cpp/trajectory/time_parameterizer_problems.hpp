/// @file
/// Seeded random sections of path and limits, and a check of limits by dense sampling that shares
/// nothing with the certificate.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::testing {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline double decades(Random& random, double low, double high) {
  return std::pow(10.0, uniform(random, std::log10(low), std::log10(high)));
}

inline JointVector direction(Random& random, int joints) {
  std::normal_distribution<double> normal;
  JointVector d(joints);
  for (int i = 0; i < joints; ++i) d[i] = normal(random);
  return d.normalized();
}

inline JointLimits limits_of(const JointVector& velocity, const JointVector& acceleration,
                             const JointVector& jerk) {
  const auto n = velocity.size();
  JointLimits limits;
  limits.position_min = JointVector::Constant(n, -1e6);
  limits.position_max = JointVector::Constant(n, 1e6);
  limits.velocity = velocity;
  limits.acceleration = acceleration;
  limits.jerk = jerk;
  limits.coupling.resize(0, n);
  limits.coupling_lower.resize(0);
  limits.coupling_upper.resize(0);
  return limits;
}

/// Six joints of a usual arm.
inline JointLimits arm_limits() {
  JointVector v(6);
  v << 2.1, 2.1, 2.6, 4.0, 4.0, 6.0;
  return limits_of(v, 10.0 * v, 100.0 * v);
}

/// Limits with time constants v/a and a/j over `spread` decades either side of a tenth of a second.
inline JointLimits random_limits(Random& random, int joints, double spread) {
  JointVector v(joints), a(joints), j(joints);
  const double low = std::pow(10.0, -spread), high = std::pow(10.0, spread);
  const double speed = decades(random, low, high);
  const double rise = 10.0 * decades(random, low, high), jerk = 10.0 * decades(random, low, high);
  for (int i = 0; i < joints; ++i) {
    v[i] = speed * decades(random, 0.3, 3.0);
    a[i] = rise * v[i] * decades(random, 0.3, 3.0);
    j[i] = jerk * a[i] * decades(random, 0.3, 3.0);
  }
  return limits_of(v, a, j);
}

/// A corner at c: quintic Bézier with control points c − d u1, c − d/2 u1, c, c, c + d/2 u2,
/// c + d u2, over 2.5 d of s. It leaves the legs by at most 0.109375 d ‖u2 − u1‖.
inline JointPiece corner(const JointVector& c, const JointVector& u1, const JointVector& u2,
                         double d) {
  PathPoint from, to;
  const JointVector zero = JointVector::Zero(c.size());
  from = {c - d * u1, u1, zero, zero};
  to = {c + d * u2, u2, zero, zero};
  // q'' vanishes at both ends because the first three control points are evenly spaced.
  JointPiece piece = JointPiece::hermite(from, to, 2.5 * d);
  piece.kind = PieceKind::kBlend;
  return piece;
}

/// Joint lines of unit speed through the points, with rounded corners that leave them by at most
/// `deviation` and take at most `share` of half a leg.
inline JointPath cornered_path(const std::vector<JointVector>& points, double deviation,
                               double share = 0.98) {
  std::vector<JointVector> units;
  std::vector<double> lengths;
  for (size_t k = 0; k + 1 < points.size(); ++k) {
    const JointVector leg = points[k + 1] - points[k];
    lengths.push_back(leg.norm());
    units.push_back(leg / lengths.back());
  }
  JointPath path;
  double cut_before = 0.0;
  for (size_t k = 0; k < units.size(); ++k) {
    double d = 0.0;
    if (k + 1 < units.size()) {
      const double turn = (units[k + 1] - units[k]).norm();
      d = std::min(
          {deviation / (0.109375 * turn), 0.5 * share * lengths[k], 0.5 * share * lengths[k + 1]});
    }
    const JointVector a = points[k] + cut_before * units[k];
    const JointVector b = points[k + 1] - d * units[k];
    path.append(JointPiece::line(a, b, lengths[k] - cut_before - d));
    if (k + 1 < units.size()) path.append(corner(points[k + 1], units[k], units[k + 1], d));
    cut_before = d;
  }
  return path;
}

inline std::vector<JointVector> random_walk(Random& random, int joints, int legs, double low,
                                            double high) {
  std::vector<JointVector> points{JointVector::Zero(joints)};
  for (int k = 0; k < legs; ++k) {
    points.push_back(points.back() + decades(random, low, high) * direction(random, joints));
  }
  return points;
}

/// Quintic pieces through random points with random q', q'' at the knots.
inline JointPath random_spline(Random& random, int joints, int pieces, double size,
                               double wildness) {
  std::vector<PathPoint> knots;
  std::vector<double> lengths;
  JointVector q = JointVector::Zero(joints);
  for (int k = 0; k <= pieces; ++k) {
    const double typical = wildness * size;
    PathPoint p;
    p.q = q;
    p.q1 = direction(random, joints) + wildness * direction(random, joints);
    p.q2 = typical > 0.0 ? JointVector(wildness / size * direction(random, joints))
                         : JointVector::Zero(joints);
    p.q3 = JointVector::Zero(joints);
    knots.push_back(p);
    lengths.push_back(size * decades(random, 0.5, 2.0));
    q += lengths.back() * direction(random, joints);
  }
  JointPath path;
  for (int k = 0; k < pieces; ++k) {
    const auto i = static_cast<size_t>(k);
    path.append(JointPiece::hermite(knots[i], knots[i + 1], lengths[i]));
  }
  return path;
}

inline double duration_of(std::span<const TrajectoryPiece> pieces) {
  double sum = 0.0;
  for (const TrajectoryPiece& piece : pieces) sum += piece.duration;
  return sum;
}

/// Largest share of v, a, j over `samples` instants of every piece.
inline double sampled_share(std::span<const TrajectoryPiece> pieces, const JointLimits& limits,
                            int samples) {
  double worst = 0.0;
  for (const TrajectoryPiece& piece : pieces) {
    for (int k = 0; k <= samples; ++k) {
      const JointState state = piece.at(piece.duration * k / samples);
      worst = std::max({worst, state.qd.cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff(),
                        state.qdd.cwiseQuotient(limits.acceleration).cwiseAbs().maxCoeff(),
                        state.qddd.cwiseQuotient(limits.jerk).cwiseAbs().maxCoeff()});
    }
  }
  return worst;
}

}  // namespace viapoint::testing
