/// @file
/// How the tool turns over a parameter s: at a constant rate about one axis, or through several
/// orientations with a continuous angular acceleration (C² on SO(3)).
#pragma once

#include <span>
#include <vector>

#include "viapoint/core/pose.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint {

/// Rotation and its rates by s, base frame: R' = [w]× R, w1 and w2 the derivatives of w.
struct OrientationPoint {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d w, w1, w2;
};

/// Upper bounds over an interval of s.
struct OrientationBounds {
  double w = 0.0, w1 = 0.0, w2 = 0.0;
};

/// w and w1 are continuous, w2 bounded. Immutable. Real-time: not. Threads: any.
class OrientationCurve {
 public:
  virtual ~OrientationCurve() = default;
  [[nodiscard]] virtual OrientationPoint at(double s) const = 0;
  [[nodiscard]] virtual OrientationBounds bounds(double s0, double s1) const = 0;
  /// The last place in (s0, s1) where w2 may jump; s1 where there is none.
  [[nodiscard]] virtual double last_break(double s0, double s1) const;
};

/// R(s) = exp(rate·s) R(0), the rate in the base frame [rad per s]; zero: the orientation stays.
class SteadyTurn final : public OrientationCurve {
 public:
  SteadyTurn(Eigen::Matrix3d from, Eigen::Vector3d rate)
      : from_(std::move(from)), rate_(std::move(rate)) {}
  /// By the least rotation, over `length` of s.
  [[nodiscard]] static SteadyTurn between(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to,
                                          double length);

  [[nodiscard]] OrientationPoint at(double s) const override;
  [[nodiscard]] OrientationBounds bounds(double s0, double s1) const override;

 private:
  Eigen::Matrix3d from_;
  Eigen::Vector3d rate_;
};

/// Where an orientation spline passes, and how fast it turns there (base frame, by s).
struct OrientationKnot {
  double s = 0.0;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d w, w1;
};

/// Through knots in turn: from knot to knot R(s) = exp(φ(s)) R_k, with φ the quintic that meets
/// both orientations and both knots' w and w'. Those carry over to φ' and φ'' by the derivative of
/// the exponential (Bullo & Murray 1995), so w and w' are continuous everywhere: C² on SO(3).
/// Bounds. With w = ∫₀¹ exp(τφ) φ' dτ and its derivatives by the same rule,
///   ‖w‖ <= ‖φ'‖, ‖w'‖ <= ‖φ''‖ + ½‖φ'‖², ‖w''‖ <= ‖φ'''‖ + 3/2 ‖φ'‖‖φ''‖ + ½‖φ'‖³.
class OrientationSpline final : public OrientationCurve {
 public:
  /// @param knots at least 2, s rising from 0, neighbours less than 180° apart
  /// @throws MotionError(kHalfTurn) naming the pair that is not, kBadArgument
  explicit OrientationSpline(std::span<const OrientationKnot> knots);
  /// Through orientations alone: the rates at the knots are those of the natural cubic spline
  /// through the polygon that the rotation vectors from each to the next make when laid end to end
  /// (after Park & Ravani 1997). About one fixed axis that is the cubic spline of the angle itself.
  [[nodiscard]] static OrientationSpline through(std::span<const Eigen::Matrix3d> rotations,
                                                 std::span<const double> at);

  [[nodiscard]] OrientationPoint at(double s) const override;
  [[nodiscard]] OrientationBounds bounds(double s0, double s1) const override;
  [[nodiscard]] double last_break(double s0, double s1) const override;
  /// R_k of every span.
  [[nodiscard]] const std::vector<Eigen::Matrix3d>& bases() const { return bases_; }
  /// φ of every span, three columns.
  [[nodiscard]] const JointPath& vectors() const { return vectors_; }

 private:
  std::vector<Eigen::Matrix3d> bases_;
  JointPath vectors_;  ///< φ of every span, three columns; begins anew at zero in each
};

/// The rotation and rates of exp(φ) base, from φ and its derivatives by s.
[[nodiscard]] OrientationPoint exponential_point(const Eigen::Vector3d& vector,
                                                 const Eigen::Vector3d& vector1,
                                                 const Eigen::Vector3d& vector2,
                                                 const Eigen::Vector3d& vector3,
                                                 const Eigen::Matrix3d& base);

}  // namespace viapoint
