#include "viapoint/path/position_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "path/chain_bounds.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// Points nearer than this [m] do not define a circle: rounding of a teach file is larger.
constexpr double kSamePoint = 1e-6;
/// Three points count as one line where the middle one is off it by less than this share of the
/// largest distance: the circle would be a hundred thousand times as large.
constexpr double kStraight = 1e-6;
/// Below this travel [m] the parameter is the angle, as for a straight line.
constexpr double kTravelFloor = 1e-9;

[[noreturn]] void refuse(std::string message, double value, std::vector<std::string> ways_out) {
  Problem problem;
  problem.code = ErrorCode::kDegenerateCurve;
  problem.message = std::move(message);
  problem.value = value;
  problem.ways_out = std::move(ways_out);
  throw MotionError(std::move(problem));
}

}  // namespace

double PositionCurve::last_break(double /*s0*/, double s1) const { return s1; }

HelixCurve::HelixCurve(const Eigen::Vector3d& start, const Eigen::Vector3d& center,
                       const Eigen::Vector3d& axis, double angle, double pitch)
    : angle_(angle), rise_(pitch / (2.0 * kPi)) {
  if (!start.allFinite() || !center.allFinite() || !axis.allFinite() || !std::isfinite(angle) ||
      !std::isfinite(pitch)) {
    throw MotionError(ErrorCode::kBadArgument, "an arc with a value that is not finite");
  }
  const double size = axis.stableNorm();
  if (!(size > kTravelFloor)) {
    refuse("the axis of the arc has no direction: its length is " + std::to_string(size), size,
           {"give the axis as a direction, e.g. (0, 0, 1)"});
  }
  axis_ = axis / size;
  foot_ = center + axis_ * axis_.dot(start - center);
  radial_ = start - foot_;
  tangential_ = axis_.cross(radial_);
  const double travel = std::abs(angle) * std::hypot(radial_.norm(), rise_);
  length_ = travel > kTravelFloor ? travel : std::abs(angle);
  rate_ = length_ > 0.0 ? angle / length_ : 0.0;
}

HelixCurve HelixCurve::through(const Eigen::Vector3d& start, const Eigen::Vector3d& via,
                               const Eigen::Vector3d& end) {
  const Eigen::Vector3d to_via = via - start;
  const Eigen::Vector3d to_end = end - start;
  const auto require_apart = [](double distance, const char* pair) {
    if (distance > kSamePoint) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "%s of the arc are the same point (%.3g mm apart): they define no circle", pair,
                  distance / kMillimetre);
    refuse(text, distance,
           {"give three different points",
            "a full circle, or more: movec(center=..., axis=..., angle=...)"});
  };
  require_apart(to_via.norm(), "start and via point");
  require_apart((end - via).norm(), "via point and end");
  require_apart(to_end.norm(), "start and end");
  const Eigen::Vector3d normal = to_via.cross(to_end);
  const double longest = std::max({to_via.norm(), to_end.norm(), (end - via).norm()});
  const double off = normal.norm() / longest;
  if (off <= kStraight * longest) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "the three points of the arc lie on one straight line, to %.3g mm: no circle goes "
        "through them",
        off / kMillimetre);
    refuse(text, off, {"move the via point off the line", "use movel(...) for a straight line"});
  }
  // The centre from start, in the plane of the points (the circumcentre in barycentric form).
  const Eigen::Vector3d center = start + (to_via.squaredNorm() * to_end.cross(normal) +
                                          to_end.squaredNorm() * normal.cross(to_via)) /
                                             (2.0 * normal.squaredNorm());
  // Seen along start → via → end the turn is positive about their normal, from 0 to one turn.
  const Eigen::Vector3d axis = normal.normalized();
  const Eigen::Vector3d from = start - center;
  const Eigen::Vector3d to = end - center;
  double angle = std::atan2(axis.dot(from.cross(to)), from.dot(to));
  if (angle <= 0.0) angle += 2.0 * kPi;
  return {start, center, axis, angle};
}

PositionPoint HelixCurve::at(double s) const {
  const double theta = rate_ * s;
  const double c = std::cos(theta);
  const double sn = std::sin(theta);
  const Eigen::Vector3d outward = c * radial_ + sn * tangential_;
  const Eigen::Vector3d ahead = c * tangential_ - sn * radial_;
  PositionPoint point;
  point.p = foot_ + outward + axis_ * (rise_ * theta);
  point.p1 = rate_ * (ahead + axis_ * rise_);
  point.p2 = -rate_ * rate_ * outward;
  point.p3 = -rate_ * rate_ * rate_ * ahead;
  return point;
}

double HelixCurve::third_bound(double /*s0*/, double /*s1*/) const {
  return std::abs(rate_ * rate_ * rate_) * radial_.norm();
}

double HelixCurve::share_at(const Eigen::Vector3d& via) const {
  const Eigen::Vector3d to = via - foot_;
  double angle = std::atan2(to.dot(tangential_), to.dot(radial_));
  if (angle_ < 0.0) angle = -angle;
  if (angle < 0.0) angle += 2.0 * kPi;
  return angle_ != 0.0 ? std::clamp(angle / std::abs(angle_), 0.0, 1.0) : 0.0;
}

PositionPoint SplineCurve::at(double s) const {
  const PathPoint point = path_.at(s);
  return {point.q, point.q1, point.q2, point.q3};
}

double SplineCurve::third_bound(double s0, double s1) const {
  return suprema_over(path_, s0, s1).q3.norm();
}

double SplineCurve::last_break(double s0, double s1) const {
  return last_start_within(path_, s0, s1);
}

}  // namespace viapoint
