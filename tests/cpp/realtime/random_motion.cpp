#include "realtime/random_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viapoint/profile/jerk_profile.hpp"

namespace viapoint {
namespace {

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
int whole(std::mt19937& random, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(random);
}
JointVector vector(std::mt19937& random, int joints, double size) {
  JointVector v(joints);
  for (int i = 0; i < joints; ++i) v[i] = uniform(random, -size, size);
  return v;
}

/// Quintic in x = τ/T with the given states at both ends.
void set_hermite(TrajectoryPiece& piece, std::size_t i, const AxisState& a, const AxisState& b) {
  const double T = piece.duration, h = b.q - a.q;
  const double v0 = a.qd * T, v1 = b.qd * T, a0 = a.qdd * T * T, a1 = b.qdd * T * T;
  const double c[6] = {a.q,
                       v0,
                       0.5 * a0,
                       10 * h - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1,
                       -15 * h + 8 * v0 + 7 * v1 + 1.5 * a0 - a1,
                       6 * h - 3 * (v0 + v1) - 0.5 * (a0 - a1)};
  for (std::size_t k = 0; k < 6; ++k) piece.path[k][i] = c[k];
}

}  // namespace

JointLimits even_limits(int joints, double velocity, double acceleration, double jerk) {
  JointLimits limits;
  const double far = std::numeric_limits<double>::infinity();
  limits.position_min = JointVector::Constant(joints, -far);
  limits.position_max = JointVector::Constant(joints, far);
  limits.velocity = JointVector::Constant(joints, velocity);
  limits.acceleration = JointVector::Constant(joints, acceleration);
  limits.jerk = JointVector::Constant(joints, jerk);
  limits.coupling.resize(0, joints);
  limits.coupling_lower.resize(0);
  limits.coupling_upper.resize(0);
  return limits;
}

void append_straight(std::vector<TrajectoryPiece>& pieces, const JointVector& start,
                     const JointVector& step, const JointLimits& limits, int move) {
  double v = 1e300, a = 1e300, j = 1e300;
  for (int i = 0; i < step.size(); ++i) {
    const double size = std::max(std::abs(step[i]), 1e-12);
    v = std::min(v, limits.velocity[i] / size);
    a = std::min(a, limits.acceleration[i] / size);
    j = std::min(j, limits.jerk[i] / size);
  }
  const JerkProfile profile = rest_to_rest(1.0, v, a, j);
  double t = 0.0;
  for (int k = 0; k < profile.phases; ++k) {
    const auto phase = static_cast<std::size_t>(k);
    const double T = profile.duration[phase];
    if (T <= 0.0) continue;
    const AxisState s = profile.at(t);
    TrajectoryPiece piece;
    piece.duration = T;
    piece.joints = static_cast<std::int32_t>(step.size());
    piece.move = move;
    piece.timing = {s.q, s.qd * T, 0.5 * s.qdd * T * T, profile.jerk[phase] * T * T * T / 6.0,
                    0.0, 0.0};
    for (int i = 0; i < step.size(); ++i) {
      piece.path[0][static_cast<std::size_t>(i)] = start[i];
      piece.path[1][static_cast<std::size_t>(i)] = step[i];
    }
    pieces.push_back(piece);
    t += T;
  }
}

void append_wait(std::vector<TrajectoryPiece>& pieces, const JointVector& position, double seconds,
                 int move) {
  TrajectoryPiece piece;
  piece.duration = seconds;
  piece.joints = static_cast<std::int32_t>(position.size());
  piece.move = move;
  for (int i = 0; i < position.size(); ++i) {
    piece.path[0][static_cast<std::size_t>(i)] = position[i];
  }
  piece.timing[1] = 1.0;
  pieces.push_back(piece);
}

Motion motion_at_its_limits(std::vector<TrajectoryPiece> pieces) {
  const int joints = pieces.front().joints;
  Motion motion;
  motion.limits = even_limits(joints, 1e12, 1e12, 1e12);
  const Certificate reached = certify(pieces, motion.limits);
  for (int i = 0; i < joints; ++i) {
    const auto at = static_cast<std::size_t>(i);
    motion.limits.velocity[i] = reached.velocity[at].value;
    motion.limits.acceleration[i] = reached.acceleration[at].value;
    motion.limits.jerk[i] = reached.jerk[at].value;
  }
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

Motion straight_motion(std::mt19937& random) {
  const int joints = whole(random, 1, 7);
  Motion motion;
  motion.limits = even_limits(joints, 1.0, 1.0, 1.0);
  for (int i = 0; i < joints; ++i) {
    const double v = std::exp(uniform(random, std::log(0.3), std::log(6.0)));
    const double a = v * std::exp(uniform(random, std::log(2.0), std::log(30.0)));
    motion.limits.velocity[i] = v;
    motion.limits.acceleration[i] = a;
    motion.limits.jerk[i] = a * std::exp(uniform(random, std::log(2.0), std::log(200.0)));
  }
  std::vector<TrajectoryPiece> pieces;
  JointVector q = vector(random, joints, 1.0);
  const int moves = whole(random, 1, 4);
  for (int m = 0; m < moves; ++m) {
    if (whole(random, 0, 2) == 0) append_wait(pieces, q, uniform(random, 0.001, 0.2), m);
    const JointVector step =
        vector(random, joints, std::exp(uniform(random, std::log(0.01), std::log(2.0))));
    append_straight(pieces, q, step, motion.limits, m);
    q += step;
  }
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

Motion curved_motion(std::mt19937& random) {
  const int joints = whole(random, 1, 7);
  const int count = whole(random, 2, 12);
  const double typical = std::exp(uniform(random, std::log(0.01), std::log(0.5)));
  std::vector<TrajectoryPiece> pieces(static_cast<std::size_t>(count));
  for (auto& piece : pieces) {
    piece.duration = typical * uniform(random, 0.3, 2.0);
    piece.joints = joints;
    piece.timing[1] = 1.0;
    piece.move = static_cast<std::int32_t>(&piece - pieces.data());
  }
  for (int i = 0; i < joints; ++i) {
    AxisState state;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      AxisState next;
      const double T = pieces[p].duration;
      next.q = state.q + 0.5 * state.qd * T + uniform(random, -1.0, 1.0) * T;
      if (p + 1 < pieces.size()) {
        next.qd = uniform(random, -1.0, 1.0);
        next.qdd = uniform(random, -1.0, 1.0) / typical;
      }
      set_hermite(pieces[p], static_cast<std::size_t>(i), state, next);
      state = next;
    }
  }
  return motion_at_its_limits(std::move(pieces));
}

Motion dense_motion(int moves) {
  Motion motion;
  motion.limits = even_limits(2, 3.0, 3000.0, 3e6);
  std::vector<TrajectoryPiece> pieces;
  JointVector q = JointVector::Zero(2);
  for (int m = 0; m < moves; ++m) {
    const double size = (m % 2 == 0 ? 1e-8 : -1e-8) * (1 + m % 3);
    JointVector step(2);
    step << size, -size;
    append_straight(pieces, q, step, motion.limits, m);
    q += step;
  }
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

Motion random_motion(std::mt19937& random) {
  return whole(random, 0, 1) == 0 ? straight_motion(random) : curved_motion(random);
}

}  // namespace viapoint
