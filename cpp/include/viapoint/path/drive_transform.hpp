/// @file
/// The drive transform (Paul 1981, ch. 5): the tool's way from one pose to the next as a
/// translation, a turn of the approach axis about one fixed axis and a turn about the approach
/// axis, all three linear in time. The classic timed Cartesian motion is made of it.
///
/// Its transitions are C² in position, but not C¹ in orientation: psi turns at a constant rate
/// within them and not outside, so the tool's angular velocity jumps at their ends. That is the
/// method's own fault; use it for study.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "viapoint/core/pose.hpp"
#include "viapoint/profile/polynomial.hpp"

namespace viapoint {

/// D = T(position) Ra(psi, theta) Ro(phi) with from · D = to: Ra turns by theta about the axis
/// (−sin psi, cos psi, 0) of `from`, Ro by phi about the approach axis (z).
struct DriveTransform {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the frame of `from` [m]
  double psi = 0.0;    ///< [rad], in (−π, π]; 0 where theta is 0 or π
  double theta = 0.0;  ///< [rad], in [0, π]
  double phi = 0.0;    ///< [rad], in (−π, π]

  /// The transform that leads from one pose to the other.
  [[nodiscard]] static DriveTransform between(const Pose& from, const Pose& to);
  /// As a pose in the frame it starts from.
  [[nodiscard]] Pose pose() const;
};

/// The tool at an instant, base frame.
struct ToolState {
  Pose pose = Pose::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();              ///< of the tool point [m/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();          ///< [m/s²]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      ///< [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< [rad/s²]
};

/// Timed Cartesian motion through any number of poses: the drive transform with fixed psi on lines,
/// quartic transitions of ±t_acc about the inner poses, in which psi goes linearly over to that of
/// the next leg. Immutable. Real-time: not (it owns vectors). Threads: any.
class DriveMotion {
 public:
  /// @param poses (k,), k >= 2; @param durations (k − 1,) [s]
  /// @throws MotionError(kBadArgument), see check_transitions()
  DriveMotion(std::span<const Pose> poses, std::span<const double> durations, double t_acc);

  [[nodiscard]] double duration() const { return parts_.back().end; }
  /// Lines and transitions in turn.
  [[nodiscard]] size_t parts() const { return parts_.size(); }
  [[nodiscard]] double start_of(size_t part) const { return parts_[part].start; }
  [[nodiscard]] double end_of(size_t part) const { return parts_[part].end; }
  /// State at t by the law of one part, so that an instant between two can be seen from both.
  [[nodiscard]] ToolState at(size_t part, double t) const;
  /// State at t, clamped to [0, duration()]; between two parts that of the later one.
  [[nodiscard]] ToolState at(double t) const;

 private:
  struct Part {
    double start = 0.0, end = 0.0;  ///< [s]
    Pose seen_from;                 ///< the frame its coordinates are in
    std::array<Polynomial, 3> position;
    Polynomial psi, theta, phi;
  };
  void add_line(const Pose& from, const Pose& to, double point_time, double duration, double start,
                double end);
  void add_transition(const Pose& before, const Pose& here, const Pose& after, double point_time,
                      double duration_after, double t_acc);

  std::vector<Part> parts_;
};

}  // namespace viapoint
