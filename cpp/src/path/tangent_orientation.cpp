#include "viapoint/path/tangent_orientation.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kFewestKnots = 16;
constexpr int kMostKnots = 1 << 14;
constexpr int kPlacesBetween = 7;

/// The unit direction of a curve and its derivatives by s.
struct Direction {
  Vector3d p, t, t1, t2;
};

Direction direction_at(const PositionCurve& curve, double s) {
  const PositionPoint point = curve.at(s);
  const double v = point.p1.norm();
  Direction direction{point.p, point.p1 / v, {}, {}};
  // p' = v t, differentiated twice.
  const Vector3d& t = direction.t;
  const double v1 = t.dot(point.p2);
  direction.t1 = (point.p2 - v1 * t) / v;
  const double v2 = direction.t1.dot(point.p2) + t.dot(point.p3);
  direction.t2 = (point.p3 - v2 * t - 2.0 * v1 * direction.t1) / v;
  return direction;
}

Matrix3d reflection(const Vector3d& normal) {
  return Matrix3d::Identity() - (2.0 / normal.squaredNorm()) * normal * normal.transpose();
}

/// The rotation between the frames of neighbours: first mirrored in the middle of the points, then
/// so that the mirrored direction becomes the new one.
Matrix3d double_reflection(const Direction& from, const Direction& to) {
  const Matrix3d first = reflection(to.p - from.p);
  return reflection(to.t - first * from.t) * first;
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

[[noreturn]] void refuse(double s, double length) {
  Problem problem;
  problem.code = ErrorCode::kDegenerateCurve;
  problem.share = s / length;
  problem.message = "at " + std::to_string(100.0 * s / length) +
                    " % of the curve its direction jumps: no orientation can follow it";
  problem.ways_out = {"round the curve off there",
                      "orientation=\"fixed\" keeps the orientation of the start"};
  throw MotionError(std::move(problem));
}

}  // namespace

OrientationSpline follow_tangent(const PositionCurve& curve, const Matrix3d& from,
                                 double tolerance) {
  const double length = curve.length();
  const Vector3d in_tool = from.transpose() * direction_at(curve, 0.0).t;
  double worst_s = 0.0;
  for (int count = kFewestKnots; count <= kMostKnots; count *= 2) {
    std::vector<OrientationKnot> knots;
    Direction before = direction_at(curve, 0.0);
    Matrix3d rotation = from;
    for (int k = 0; k <= count; ++k) {
      const double s = k == count ? length : length * k / count;
      const Direction here = direction_at(curve, s);
      if (k > 0) rotation = double_reflection(before, here) * rotation;
      if (!rotation.allFinite()) refuse(s, length);
      knots.push_back({s, rotation, here.t.cross(here.t1), here.t.cross(here.t2)});
      before = here;
    }
    OrientationSpline spline(knots);
    double worst = 0.0;
    for (int i = 0; i < count * (kPlacesBetween + 1); ++i) {
      const double s = length * i / (count * (kPlacesBetween + 1));
      const double off = angle_between(spline.at(s).rotation * in_tool, direction_at(curve, s).t);
      if (!(off <= worst)) {
        worst = off;
        worst_s = s;
      }
    }
    if (worst <= tolerance) return spline;
  }
  refuse(worst_s, length);
}

}  // namespace viapoint
