#include "viapoint/path/task_curve.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// Below this much travel [m] a line is a turn on the spot: its parameter is the angle.
constexpr double kTravelFloor = 1e-9;
/// How near to 180° the least rotation counts as not unique [rad].
constexpr double kHalfTurnSlack = 1e-9;

}  // namespace

double TaskCurve::last_break(double /*s0*/, double s1) const { return s1; }

CurvePoint ToolCurve::at(double s) const {
  const PositionPoint where = position_->at(s);
  const OrientationPoint turn = orientation_->at(s);
  return {where.p, where.p1, where.p2, where.p3, turn.rotation, turn.w, turn.w1, turn.w2};
}

CurveBounds ToolCurve::bounds(double s0, double s1) const {
  const OrientationBounds turn = orientation_->bounds(s0, s1);
  return {position_->third_bound(s0, s1), turn.w, turn.w1, turn.w2};
}

double ToolCurve::last_break(double s0, double s1) const {
  const double of_position = position_->last_break(s0, s1);
  const double of_turn = orientation_->last_break(s0, s1);
  if (of_position >= s1) return of_turn;
  return of_turn >= s1 ? of_position : std::max(of_position, of_turn);
}

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
