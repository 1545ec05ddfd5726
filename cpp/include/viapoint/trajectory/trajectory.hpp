/// @file
/// A finished motion: pieces in time order and their proof. The one header of this module that
/// real-time code includes.
#pragma once

#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/trajectory/certificate.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// Immutable once built. Threads: any.
class Trajectory {
 public:
  Trajectory() = default;
  /// Certifies against `limits`. @throws MotionError(kBadArgument) for pieces that are empty, of
  /// differing joints, not finite, or of no duration.
  Trajectory(std::vector<TrajectoryPiece> pieces, const JointLimits& limits);

  [[nodiscard]] int joints() const { return pieces_.empty() ? 0 : pieces_.front().joints; }
  [[nodiscard]] double duration() const { return duration_; }
  [[nodiscard]] const std::vector<TrajectoryPiece>& pieces() const { return pieces_; }
  /// Nominal time at which piece i begins [s].
  [[nodiscard]] double start_of(size_t piece) const { return starts_[piece]; }
  [[nodiscard]] const Certificate& certificate() const { return certificate_; }
  /// The planner adds what it alone knows (deviations, manipulability).
  [[nodiscard]] Certificate& certificate() { return certificate_; }
  /// State at t, clamped to [0, duration].
  [[nodiscard]] JointState at(double t) const;
  [[nodiscard]] size_t piece_at(double t) const;

 private:
  std::vector<TrajectoryPiece> pieces_;
  std::vector<double> starts_;
  double duration_ = 0.0;
  Certificate certificate_;
};

}  // namespace viapoint
