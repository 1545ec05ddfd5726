#include "viapoint/path/task_curve.hpp"

#include <cmath>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// Below this much travel [m] a line is a turn on the spot: its parameter is the angle.
constexpr double kTravelFloor = 1e-9;
/// How near to 180° the least rotation counts as not unique [rad].
constexpr double kHalfTurnSlack = 1e-9;

}  // namespace

LineCurve::LineCurve(const Pose& from, const Pose& to)
    : from_(from.translation()),
      direction_(Eigen::Vector3d::Zero()),
      rotation_(from.linear()),
      rate_(Eigen::Vector3d::Zero()) {
  const Eigen::Vector3d travel = to.translation() - from.translation();
  const Eigen::Vector3d turn = rotation_log(to.linear() * from.linear().transpose());
  length_ = travel.stableNorm() > kTravelFloor ? travel.stableNorm() : turn.norm();
  half_turn_ = turn.norm() >= kPi - kHalfTurnSlack;
  if (length_ > 0.0) {
    direction_ = travel / length_;
    rate_ = turn / length_;
  }
}

LineCurve LineCurve::fixed_orientation(const Pose& from, const Eigen::Vector3d& to) {
  Pose goal = from;
  goal.translation() = to;
  return LineCurve(from, goal);
}

CurvePoint LineCurve::at(double s) const {
  CurvePoint point;
  point.p = from_ + direction_ * s;
  point.p1 = direction_;
  point.p2.setZero();
  point.p3.setZero();
  point.rotation = rotation_exp(rate_ * s) * rotation_;
  point.w = rate_;
  point.w1.setZero();
  point.w2.setZero();
  return point;
}

CurveBounds LineCurve::bounds(double /*s0*/, double /*s1*/) const {
  CurveBounds bounds;
  bounds.w = rate_.norm();
  return bounds;
}

}  // namespace viapoint
