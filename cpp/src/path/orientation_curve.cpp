#include "viapoint/path/orientation_curve.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "path/chain_bounds.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/path/spline.hpp"

namespace viapoint {
namespace {

using Vector3 = Eigen::Vector3d;

/// How near to 180° the least rotation counts as not unique [rad].
constexpr double kHalfTurnSlack = 1e-9;

/// A function of x and its derivatives by x.
struct Jet {
  double value, first, second;
};

/// Σ_k (−x)^k / (2k + offset)! and its two derivatives. Alternating with small terms for all
/// x <= (2π)², so nothing cancels.
Jet alternating_series(double x, int offset) {
  constexpr int kTerms = 24;
  std::array<double, kTerms> coefficient{};
  double factorial = 1.0;
  for (int i = 2; i <= offset; ++i) factorial *= i;
  double sign = 1.0;
  for (int k = 0; k < kTerms; ++k) {
    coefficient[static_cast<size_t>(k)] = sign / factorial;
    factorial *= (2.0 * k + offset + 1.0) * (2.0 * k + offset + 2.0);
    sign = -sign;
  }
  Jet jet{0.0, 0.0, 0.0};
  for (int k = kTerms - 1; k >= 0; --k) {
    jet.second = jet.second * x + 2.0 * jet.first;
    jet.first = jet.first * x + jet.value;
    jet.value = jet.value * x + coefficient[static_cast<size_t>(k)];
  }
  return jet;
}

Jet along(const Jet& by_x, double x1, double x2) {
  return {by_x.value, by_x.first * x1, by_x.second * x1 * x1 + by_x.first * x2};
}

/// The left Jacobian J of the exponential: w = J(φ) φ'.
Eigen::Matrix3d left_jacobian(const Vector3& vector) {
  const double x = vector.squaredNorm();
  const double a = alternating_series(x, 2).value;
  const double b = alternating_series(x, 3).value;
  Eigen::Matrix3d cross;
  cross << 0.0, -vector.z(), vector.y(), vector.z(), 0.0, -vector.x(), -vector.y(), vector.x(), 0.0;
  return Eigen::Matrix3d::Identity() + a * cross + b * cross * cross;
}

/// φ from one knot to the next, and φ', φ'' that give the knots' rates.
JointPiece vector_piece(const OrientationKnot& from, const OrientationKnot& to) {
  const Vector3 turn = rotation_log(to.rotation * from.rotation.transpose());
  const Eigen::PartialPivLU<Eigen::Matrix3d> jacobian(left_jacobian(turn));
  const Vector3 end1 = jacobian.solve(to.w);
  // w' = J φ'' + what φ' alone makes.
  const Vector3 zero = Vector3::Zero();
  const Vector3 without_bend =
      exponential_point(turn, end1, zero, zero, Eigen::Matrix3d::Identity()).w1;
  const Vector3 end2 = jacobian.solve(to.w1 - without_bend);
  return JointPiece::hermite({zero, from.w, from.w1, zero}, {turn, end1, end2, zero},
                             to.s - from.s);
}

void check_knots(std::span<const OrientationKnot> knots) {
  if (knots.size() < 2) {
    throw MotionError(ErrorCode::kBadArgument, "an orientation spline needs at least two knots");
  }
  for (size_t k = 1; k < knots.size(); ++k) {
    if (!(knots[k].s > knots[k - 1].s)) {
      throw MotionError(ErrorCode::kBadArgument,
                        "orientation " + std::to_string(k) + " is not placed after the one before");
    }
    const double apart = rotation_distance(knots[k - 1].rotation, knots[k].rotation);
    if (apart < kPi - kHalfTurnSlack) continue;
    Problem problem;
    problem.code = ErrorCode::kHalfTurn;
    problem.message = "orientations " + std::to_string(k - 1) + " and " + std::to_string(k) +
                      " of the curve are 180° apart: the least rotation between them is not unique";
    problem.value = apart;
    problem.ways_out = {"add a point between them that says which way to turn",
                        "orientation=\"fixed\" keeps the orientation of the start"};
    throw MotionError(std::move(problem));
  }
}

}  // namespace

OrientationPoint exponential_point(const Vector3& vector, const Vector3& vector1,
                                   const Vector3& vector2, const Vector3& vector3,
                                   const Eigen::Matrix3d& base) {
  // w = φ' + a φ×φ' + b φ×(φ×φ') with a = (1 − cos θ)/θ², b = (θ − sin θ)/θ³ as series in
  // x = θ²; then the product rule.
  const double x1 = 2.0 * vector.dot(vector1);
  const double x2 = 2.0 * (vector1.squaredNorm() + vector.dot(vector2));
  const double x = vector.squaredNorm();
  const Jet a = along(alternating_series(x, 2), x1, x2);
  const Jet b = along(alternating_series(x, 3), x1, x2);
  const Vector3 c = vector.cross(vector1);
  const Vector3 c1 = vector.cross(vector2);
  const Vector3 c2 = vector1.cross(vector2) + vector.cross(vector3);
  const Vector3 d = vector.cross(c);
  const Vector3 d1 = vector1.cross(c) + vector.cross(c1);
  const Vector3 d2 = vector2.cross(c) + 2.0 * vector1.cross(c1) + vector.cross(c2);
  OrientationPoint point;
  point.rotation = rotation_exp(vector) * base;
  point.w = vector1 + a.value * c + b.value * d;
  point.w1 = vector2 + a.first * c + a.value * c1 + b.first * d + b.value * d1;
  point.w2 = vector3 + a.second * c + 2.0 * a.first * c1 + a.value * c2 + b.second * d +
             2.0 * b.first * d1 + b.value * d2;
  return point;
}

double OrientationCurve::last_break(double /*s0*/, double s1) const { return s1; }

SteadyTurn SteadyTurn::between(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to,
                               double length) {
  const Vector3 turn = rotation_log(to * from.transpose());
  const Vector3 rate = length > 0.0 ? Vector3(turn / length) : Vector3::Zero();
  return {from, rate};
}

OrientationPoint SteadyTurn::at(double s) const {
  OrientationPoint point;
  point.rotation = rotation_exp(rate_ * s) * from_;
  point.w = rate_;
  point.w1.setZero();
  point.w2.setZero();
  return point;
}

OrientationBounds SteadyTurn::bounds(double /*s0*/, double /*s1*/) const {
  return {rate_.norm(), 0.0, 0.0};
}

OrientationSpline::OrientationSpline(std::span<const OrientationKnot> knots) {
  check_knots(knots);
  bases_.reserve(knots.size() - 1);
  for (size_t k = 0; k + 1 < knots.size(); ++k) {
    bases_.push_back(knots[k].rotation);
    vectors_.append(vector_piece(knots[k], knots[k + 1]));
  }
}

OrientationSpline OrientationSpline::through(std::span<const Eigen::Matrix3d> rotations,
                                             std::span<const double> at) {
  std::vector<JointVector> polygon = {JointVector::Zero(3)};
  for (size_t k = 1; k < rotations.size(); ++k) {
    const Vector3 turn = rotation_log(rotations[k] * rotations[k - 1].transpose());
    polygon.emplace_back(polygon.back() + turn);
  }
  const std::vector<PathPoint> rates = natural_spline(polygon, at, 3);
  std::vector<OrientationKnot> knots;
  for (size_t k = 0; k < rotations.size(); ++k) {
    knots.push_back({at[k], rotations[k], rates[k].q1, rates[k].q2});
  }
  return OrientationSpline(knots);
}

OrientationPoint OrientationSpline::at(double s) const {
  const size_t k = vectors_.piece_at(s);
  const PathPoint point = vectors_.at(s);
  return exponential_point(point.q, point.q1, point.q2, point.q3, bases_[k]);
}

OrientationBounds OrientationSpline::bounds(double s0, double s1) const {
  const JointSuprema sup = suprema_over(vectors_, s0, s1);
  const double first = sup.q1.norm();
  const double second = sup.q2.norm();
  const double third = sup.q3.norm();
  return {first, second + 0.5 * first * first,
          third + 1.5 * first * second + 0.5 * first * first * first};
}

double OrientationSpline::last_break(double s0, double s1) const {
  return last_start_within(vectors_, s0, s1);
}

}  // namespace viapoint
