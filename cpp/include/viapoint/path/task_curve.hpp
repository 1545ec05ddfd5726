/// @file
/// Curves of the tool frame over a parameter s: position, rotation and exact derivatives. What a
/// Cartesian move asks for; insertion turns it into joint pieces.
#pragma once

#include <memory>
#include <utility>

#include "viapoint/core/pose.hpp"
#include "viapoint/path/orientation_curve.hpp"
#include "viapoint/path/position_curve.hpp"

namespace viapoint {

/// A tool curve and its derivatives by s, base frame. `w` is the angular rate per unit of s
/// (R' = [w]× R), w1 and w2 its derivatives.
struct CurvePoint {
  Eigen::Vector3d p, p1, p2, p3;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d w, w1, w2;
};

/// Upper bounds over an interval of s of what the deviation proof needs.
struct CurveBounds {
  double p3 = 0.0;  ///< sup ‖p'''‖
  double w = 0.0;   ///< sup ‖w‖
  double w1 = 0.0;  ///< sup ‖w'‖
  double w2 = 0.0;  ///< sup ‖w''‖
};

/// Immutable. Real-time: not. Threads: any, at once.
class TaskCurve {
 public:
  virtual ~TaskCurve() = default;
  /// Of the parameter s; 0 for a curve that goes nowhere, which insertion refuses.
  [[nodiscard]] virtual double length() const = 0;
  /// @pre 0 <= s <= length()
  [[nodiscard]] virtual CurvePoint at(double s) const = 0;
  /// Bounds that hold for every s in [s0, s1].
  [[nodiscard]] virtual CurveBounds bounds(double s0, double s1) const = 0;
  /// The last place in (s0, s1) where p''' or w'' may jump; s1 where there is none. Pieces that end
  /// there can be longer.
  [[nodiscard]] virtual double last_break(double s0, double s1) const;
};

/// Any way of the tool point with any way of turning, over one parameter.
class ToolCurve final : public TaskCurve {
 public:
  ToolCurve(std::unique_ptr<const PositionCurve> position,
            std::unique_ptr<const OrientationCurve> orientation)
      : position_(std::move(position)), orientation_(std::move(orientation)) {}

  [[nodiscard]] double length() const override { return position_->length(); }
  [[nodiscard]] CurvePoint at(double s) const override;
  [[nodiscard]] CurveBounds bounds(double s0, double s1) const override;
  [[nodiscard]] double last_break(double s0, double s1) const override;
  [[nodiscard]] const PositionCurve& position() const { return *position_; }
  [[nodiscard]] const OrientationCurve& orientation() const { return *orientation_; }

 private:
  std::unique_ptr<const PositionCurve> position_;
  std::unique_ptr<const OrientationCurve> orientation_;
};

/// Straight line with a constant rotation rate about one axis (least rotation between the ends).
/// s is the length travelled [m]; for a turn on the spot (travel under 1 nm) it is the angle [rad].
class LineCurve final : public TaskCurve {
 public:
  /// @pre both rotation blocks are rotations (checked_pose)
  LineCurve(const Pose& from, const Pose& to);
  /// Orientation stays that of `from`.
  [[nodiscard]] static LineCurve fixed_orientation(const Pose& from, const Eigen::Vector3d& to);

  [[nodiscard]] double length() const override { return length_; }
  [[nodiscard]] CurvePoint at(double s) const override;
  [[nodiscard]] CurveBounds bounds(double s0, double s1) const override;
  /// True when the two orientations are 180° apart (within 1e-9 rad): the least rotation is then
  /// not unique, and the planner refuses the move.
  [[nodiscard]] bool half_turn() const { return half_turn_; }

 private:
  Eigen::Vector3d from_, direction_;
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d rate_;  ///< base frame
  double length_ = 0.0;
  bool half_turn_ = false;
};

}  // namespace viapoint
