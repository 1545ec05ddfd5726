/// @file
/// An arm of two joints and its motions, for tests of who commands it.
#pragma once

#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::testing {

inline JointLimits wide_limits() {
  JointLimits limits;
  limits.position_min = JointVector::Constant(2, -10.0);
  limits.position_max = JointVector::Constant(2, 10.0);
  limits.velocity = JointVector::Constant(2, 5.0);
  limits.acceleration = JointVector::Constant(2, 50.0);
  limits.jerk = JointVector::Constant(2, 5000.0);
  return limits;
}

/// Both joints from `from` by 1 rad within `duration` [s], from rest to rest.
inline std::vector<TrajectoryPiece> move(double duration, double from = 0.0) {
  TrajectoryPiece piece;
  piece.duration = duration;
  piece.joints = 2;
  for (size_t joint = 0; joint < 2; ++joint) {
    piece.path[0][joint] = from;
    piece.path[1][joint] = 1.0;
  }
  piece.timing = {0.0, 0.0, 0.0, 10.0, -15.0, 6.0};
  return {piece};
}

/// Until `holds`, at most a minute.
[[nodiscard]] inline bool await(const std::function<bool()>& holds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace viapoint::testing
