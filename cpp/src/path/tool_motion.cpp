#include "path/tool_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace viapoint {
namespace {

constexpr int kDeepest = 40;
/// The search for nearest points is dearer; past this only rounding at the ends is left.
constexpr int kDeepestSearch = 24;
constexpr int kNearestSteps = 6;
/// A nearest point that moves less than this (in u) changes no distance that matters.
constexpr double kNearEnough = 1e-4;

struct Interval {
  double middle, half;
  int depth;
};

void push_halves(std::vector<Interval>& open, const Interval& interval) {
  const double quarter = 0.5 * interval.half;
  open.push_back({interval.middle - quarter, quarter, interval.depth + 1});
  open.push_back({interval.middle + quarter, quarter, interval.depth + 1});
}

/// Something in the middle of an interval, and a bound of it all over.
struct Bounded {
  double here, bound;
};
struct Search {
  double resolution, share, reached, give_up;
};

/// A bound of the largest that `measure` has over [u0, u1], see MotionSpace::bound_distance().
template <typename Measure>
double bound_largest(double u0, double u1, const Search& search, const Measure& measure) {
  double seen = search.reached;
  double proven = 0.0;
  std::vector<Interval> open = {{0.5 * (u0 + u1), 0.5 * (u1 - u0), 0}};
  while (!open.empty()) {
    const Interval interval = open.back();
    open.pop_back();
    const Bounded found = measure(interval);
    seen = std::max(seen, found.here);
    if (!(seen <= search.give_up)) return seen;
    if (found.bound <= seen * (1.0 + search.share) + search.resolution ||
        interval.depth >= kDeepest) {
      proven = std::max(proven, found.bound);
    } else {
      push_halves(open, interval);
    }
  }
  return proven;
}

JointPiece over_unit_length(JointPiece piece) {
  piece.length = 1.0;
  return piece;
}

}  // namespace

PieceMotion::PieceMotion(const JointPiece& piece) : piece_(over_unit_length(piece)) {}

JointVector PieceMotion::at(double u) const { return piece_.at(u).q; }

LocalMotion PieceMotion::over(double middle, double half) const {
  LocalMotion local;
  local.at = piece_.at(middle);
  local.sup = joint_suprema(piece_, local.at, middle, half);
  return local;
}

PathMotion::PathMotion(const JointPath& path, const Eigen::Matrix<double, 6, 1>& s_of_u)
    : path_(path) {
  s_of_u_.coefficients = s_of_u;
  s_of_u_.length = 1.0;
}

JointVector PathMotion::at(double u) const { return path_.at(s_of_u_.at(u).q[0]).q; }

LocalMotion PathMotion::over(double middle, double half) const {
  const PathPoint s = s_of_u_.at(middle);
  const JointSuprema s_sup = joint_suprema(s_of_u_, s, middle, half);
  const double s0 = s_of_u_.at(middle - half).q[0];
  const double s1 = s_of_u_.at(middle + half).q[0];
  const JointSuprema sup = suprema_over(path_, std::min(s0, s1), std::max(s0, s1));
  const PathPoint q = path_.at(s.q[0]);
  const double d1 = s.q1[0];
  const double d2 = s.q2[0];
  const double b1 = s_sup.q1[0];
  const double b2 = s_sup.q2[0];
  const double b3 = s_sup.q3[0];
  // The chain rule, on the values and on their sizes.
  LocalMotion local;
  local.at.q = q.q;
  local.at.q1 = d1 * q.q1;
  local.at.q2 = d1 * d1 * q.q2 + d2 * q.q1;
  local.sup.q1 = b1 * sup.q1;
  local.sup.q2 = b1 * b1 * sup.q2 + b2 * sup.q1;
  local.sup.q3 = b1 * b1 * b1 * sup.q3 + 3.0 * b1 * b2 * sup.q2 + b3 * sup.q1;
  return local;
}

RestMotion::RestMotion(const JointVector& q) {
  const JointVector zero = JointVector::Zero(q.size());
  local_ = {{q, zero, zero, zero}, {zero, zero, zero}};
}

JointVector RestMotion::at(double /*u*/) const { return local_.at.q; }

LocalMotion RestMotion::over(double /*middle*/, double /*half*/) const { return local_; }

MotionSpace::MotionSpace(const ForwardKinematics& arm, const JointVector& travel)
    : arm_(&arm), reach_(arm.reach_bound(travel)) {}

double MotionSpace::distance(const JointVector& a, const JointVector& b) const {
  if (arm_ == nullptr) return (a - b).norm();
  return (arm_->pose(a).translation() - arm_->pose(b).translation()).norm();
}

MotionSpace::Expansion MotionSpace::expand(const LocalMotion& local) const {
  if (arm_ == nullptr) return {local.at.q, local.at.q1, local.at.q2, local.sup.q3.norm()};
  const ChainFrames frames = arm_->frames(local.at.q);
  const auto jacobian = arm_->jacobian(frames).topRows<3>().eval();
  const auto jacobian_rate = arm_->jacobian_rate(frames, local.at.q1).topRows<3>().eval();
  return {frames.pose_base_tool.translation(), jacobian * local.at.q1,
          jacobian * local.at.q2 + jacobian_rate * local.at.q1,
          position_third_bound(*arm_, reach_, local.sup)};
}

Turning MotionSpace::expand_turn(const LocalMotion& local, double half) const {
  const ChainFrames frames = arm_->frames(local.at.q);
  const auto jacobian = arm_->jacobian(frames).bottomRows<3>().eval();
  const auto jacobian_rate = arm_->jacobian_rate(frames, local.at.q1).bottomRows<3>().eval();
  return turning_about(frames.pose_base_tool.linear(), jacobian * local.at.q1,
                       jacobian * local.at.q2 + jacobian_rate * local.at.q1,
                       rotation_second_bound(*arm_, local.sup), half);
}

MotionSpace::Vector MotionSpace::point(const JointMotion& motion, double u) const {
  if (arm_ == nullptr) return motion.at(u);
  return arm_->pose(motion.at(u)).translation();
}

double MotionSpace::bound_difference(const Expansion& a, const Expansion& b, double half) {
  const Vector e = a.value - b.value;
  const Vector e1 = half * (a.first - b.first);
  const Vector e2 = 0.5 * half * half * (a.second - b.second);
  // Control points of the quadratic part; their largest norm bounds it (Bernstein form).
  return std::max({(e - e1 + e2).norm(), (e - e2).norm(), (e + e1 + e2).norm()}) +
         half * half * half / 6.0 * (a.third + b.third);
}

double MotionSpace::bound_distance(const JointMotion& a, const JointMotion& b, double u0, double u1,
                                   double resolution, double share, double reached,
                                   double give_up) const {
  return bound_largest(u0, u1, {resolution, share, reached, give_up}, [&](const Interval& over) {
    const Expansion of_a = expand(a.over(over.middle, over.half));
    const Expansion of_b = expand(b.over(over.middle, over.half));
    return Bounded{(of_a.value - of_b.value).norm(), bound_difference(of_a, of_b, over.half)};
  });
}

double MotionSpace::angle(const JointVector& a, const JointVector& b) const {
  return rotation_distance(arm_->pose(a).linear(), arm_->pose(b).linear());
}

double MotionSpace::bound_angle(const JointMotion& a, const JointMotion& b, double u0, double u1,
                                double resolution, double share, double reached,
                                double give_up) const {
  return bound_largest(u0, u1, {resolution, share, reached, give_up}, [&](const Interval& over) {
    const Turning of_a = expand_turn(a.over(over.middle, over.half), over.half);
    const Turning of_b = expand_turn(b.over(over.middle, over.half), over.half);
    const Eigen::Vector3d phi = rotation_log(of_b.rotation.transpose() * of_a.rotation);
    return Bounded{phi.norm(), angle_bound(phi, of_a, of_b, over.half)};
  });
}

MotionSpace::Nearest MotionSpace::nearest(const Vector& wanted, const Target& target) const {
  Nearest best;
  best.target = target.motion;
  const auto distance_at = [&](double u) { return (point(*target.motion, u) - wanted).norm(); };
  for (size_t k = 0; k <= kTargetSamples; ++k) {
    const double distance = (target.points[k] - wanted).norm();
    if (distance < best.distance) {
      best.distance = distance;
      best.u = static_cast<double>(k) / kTargetSamples;
    }
  }
  // Newton on (b − wanted)·b' = 0 where that is a minimum (the curvature of the square is bounded
  // below by ‖b'‖² / 4), shorter where it does not come nearer.
  for (int step = 0; step < kNearestSteps; ++step) {
    const Expansion at = expand(target.motion->over(best.u, 0.0));
    const Vector gap = at.value - wanted;
    const double square = at.first.squaredNorm();
    const double bend = std::max(square + gap.dot(at.second), 0.25 * square);
    if (!(bend > 0.0)) break;
    double move = -gap.dot(at.first) / bend;
    if (std::abs(move) < kNearEnough) break;
    double u = best.u;
    double distance = best.distance;
    for (int halving = 0; halving < kNearestSteps && !(distance < best.distance); ++halving) {
      u = std::clamp(best.u + move, 0.0, 1.0);
      distance = distance_at(u);
      move *= 0.5;
    }
    if (!(distance < best.distance)) break;
    best.distance = distance;
    best.u = u;
  }
  return best;
}

double MotionSpace::bound_directed(const JointMotion& a,
                                   std::span<const JointMotion* const> targets, double resolution,
                                   double share, double reached) const {
  std::vector<Target> sampled;
  for (const JointMotion* motion : targets) {
    Target target;
    target.motion = motion;
    for (size_t k = 0; k <= kTargetSamples; ++k) {
      target.points[k] = point(*motion, static_cast<double>(k) / kTargetSamples);
    }
    sampled.push_back(target);
  }
  double seen = reached;
  double proven = 0.0;
  std::vector<Interval> open = {{0.5, 0.5, 0}};
  while (!open.empty()) {
    const Interval interval = open.back();
    open.pop_back();
    const Expansion of_a = expand(a.over(interval.middle, interval.half));
    Nearest near;
    for (const Target& target : sampled) {
      const Nearest here = nearest(of_a.value, target);
      if (near.target == nullptr || here.distance < near.distance) near = here;
    }
    // db/du of the stretch that follows a, and no farther than the target's ends.
    const Expansion there = expand(near.target->over(near.u, 0.0));
    const double square = there.first.squaredNorm();
    const double room = std::min(near.u, 1.0 - near.u) / interval.half;
    const double rate =
        square > 0.0 ? std::clamp(of_a.first.dot(there.first) / square, -room, room) : 0.0;
    LocalMotion stretch = near.target->over(near.u, std::abs(rate) * interval.half);
    stretch.at.q1 *= rate;
    stretch.at.q2 *= rate * rate;
    stretch.sup.q1 *= std::abs(rate);
    stretch.sup.q2 *= rate * rate;
    stretch.sup.q3 *= std::abs(rate) * rate * rate;
    const Expansion of_b = expand(stretch);
    // The sampled nearest point may not be the nearest: `seen` only steers how fine to go.
    seen = std::max(seen, (of_a.value - of_b.value).norm());
    const double bound = bound_difference(of_a, of_b, interval.half);
    if (bound <= seen * (1.0 + share) + resolution || interval.depth >= kDeepestSearch) {
      proven = std::max(proven, bound);
    } else {
      push_halves(open, interval);
    }
  }
  return proven;
}

}  // namespace viapoint
