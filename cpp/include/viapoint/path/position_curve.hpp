/// @file
/// Where the tool point goes over a parameter s: arcs, helices and splines, with exact derivatives
/// up to the third.
#pragma once

#include "viapoint/core/pose.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint {

/// The tool point and its derivatives by s, base frame.
struct PositionPoint {
  Eigen::Vector3d p, p1, p2, p3;
};

/// Continuous with two derivatives, the third bounded. Immutable. Real-time: not. Threads: any.
class PositionCurve {
 public:
  virtual ~PositionCurve() = default;
  /// Of the parameter s.
  [[nodiscard]] virtual double length() const = 0;
  /// @pre 0 <= s <= length()
  [[nodiscard]] virtual PositionPoint at(double s) const = 0;
  /// sup ‖p'''‖ over [s0, s1], or more.
  [[nodiscard]] virtual double third_bound(double s0, double s1) const = 0;
  /// The last place in (s0, s1) where p''' may jump; s1 where there is none.
  [[nodiscard]] virtual double last_break(double s0, double s1) const;
};

/// Turns about an axis while it travels along it: a circular arc without pitch, else a helix; a
/// straight line where it starts on the axis. Any angle, also more than one turn; s is the length
/// travelled [m], or the angle [rad] where the tool point stays (under 1 nm).
class HelixCurve final : public PositionCurve {
 public:
  /// @param start where it begins [m]; @param center a point of the axis [m]
  /// @param axis direction, need not be of unit length; the turn is positive about it
  /// @param angle [rad], either sign; @param pitch travel along the axis a positive turn [m]
  /// @throws MotionError(kDegenerateCurve) for an axis of no length, kBadArgument for what is not
  /// finite
  HelixCurve(const Eigen::Vector3d& start, const Eigen::Vector3d& center,
             const Eigen::Vector3d& axis, double angle, double pitch = 0.0);
  /// The arc from start by via to end.
  /// @throws MotionError(kDegenerateCurve) where the points coincide or lie on one line
  [[nodiscard]] static HelixCurve through(const Eigen::Vector3d& start, const Eigen::Vector3d& via,
                                          const Eigen::Vector3d& end);

  [[nodiscard]] double length() const override { return length_; }
  [[nodiscard]] PositionPoint at(double s) const override;
  [[nodiscard]] double third_bound(double s0, double s1) const override;

  [[nodiscard]] const Eigen::Vector3d& axis() const { return axis_; }  ///< unit
  [[nodiscard]] double angle() const { return angle_; }                ///< [rad]
  [[nodiscard]] double rise() const { return rise_; }             ///< along the axis by radian [m]
  [[nodiscard]] double radius() const { return radial_.norm(); }  ///< [m]
  [[nodiscard]] Eigen::Vector3d center() const { return foot_; }  ///< of the axis, nearest to start
  /// How far round the point nearest to `via` is passed, as a share of the whole; of an arc that
  /// goes less than once around.
  [[nodiscard]] double share_at(const Eigen::Vector3d& via) const;

 private:
  Eigen::Vector3d axis_, foot_, radial_, tangential_;
  double angle_ = 0.0;
  double rise_ = 0.0;  ///< travel along the axis by radian [m]
  double length_ = 0.0;
  double rate_ = 0.0;  ///< of the angle by s
};

/// A chain of quintics in space (spline.hpp).
class SplineCurve final : public PositionCurve {
 public:
  /// @param path three columns: x, y, z [m], C²
  explicit SplineCurve(JointPath path) : path_(std::move(path)) {}

  [[nodiscard]] double length() const override { return path_.length(); }
  [[nodiscard]] PositionPoint at(double s) const override;
  [[nodiscard]] double third_bound(double s0, double s1) const override;
  [[nodiscard]] double last_break(double s0, double s1) const override;
  [[nodiscard]] const JointPath& path() const { return path_; }

 private:
  JointPath path_;
};

}  // namespace viapoint
