/// @file
/// What crosses into real time: a finished, immutable polynomial piece of fixed size.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "viapoint/core/joint_state.hpp"

namespace viapoint {

/// Digital outputs are 0 to 63: one bit each in what the drive is sent.
inline constexpr int kDigitalOutputs = 64;

/// A digital output that changes when a piece begins.
struct OutputChange {
  std::int16_t index = 0;
  bool value = false;
};

inline constexpr int kMaxOutputsAPiece = 8;

/// Geometry and timing of a stretch of motion: q(u) is a quintic in u in [0, 1] a joint, and u(τ) a
/// quintic in x = τ/duration. Trivially copyable, so that it can go through a lock-free queue.
struct TrajectoryPiece {
  double duration = 0.0;  ///< [s] of nominal time τ, > 0
  std::array<std::array<double, kMaxJoints>, 6>
      path{};                      ///< path[k][i]: coefficient of u^k, joint i
  std::array<double, 6> timing{};  ///< coefficient of x^k; u(0), u(1) in [0, 1]
  std::int32_t joints = 0;
  std::int32_t move = 0;     ///< program step
  std::int32_t outputs = 0;  ///< how many of `output` count
  std::array<OutputChange, kMaxOutputsAPiece> output{};

  /// q and its derivatives by nominal time τ. Real-time: safe, O(n). Threads: any.
  /// @pre 0 <= tau <= duration: time is not clamped, the polynomials go on outside
  [[nodiscard]] JointState at(double tau) const noexcept;
  /// The same motion, ended at `tau`. @pre 0 < tau <= duration
  [[nodiscard]] TrajectoryPiece until(double tau) const noexcept;
};

static_assert(std::is_trivially_copyable_v<TrajectoryPiece>);

}  // namespace viapoint
