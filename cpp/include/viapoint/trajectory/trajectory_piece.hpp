/// @file
/// What crosses into real time: a finished, immutable polynomial piece of fixed size.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "viapoint/core/joint_state.hpp"

namespace viapoint {

/// Digital outputs are 0 to 63: one bit each in what the drive is sent.
inline constexpr int kDigitalOutputs = 64;

/// A digital output that changes where a piece begins.
struct OutputChange {
  std::int16_t index = 0;
  bool value = false;
  /// On the clock, after the arm passes there [s]; negative: before it does. At most
  /// kMostOutputTime either way.
  double time = 0.0;
};

inline constexpr int kMaxOutputsAPiece = 8;
/// [s]
inline constexpr double kMostOutputTime = 2.0;

/// Digital inputs are 0 to 63: one bit each in what the drive tells.
inline constexpr int kDigitalInputs = 64;

/// An input that the arm waits for, at rest, where a piece begins.
struct InputWait {
  std::int16_t input = -1;                                   ///< 0 to 63; -1 for none
  bool value = true;                                         ///< on or off
  double timeout = std::numeric_limits<double>::infinity();  ///< on the clock, > 0 [s]

  [[nodiscard]] bool any() const noexcept { return input >= 0; }
  /// @param inputs as the drive reports them, bit i for input i
  [[nodiscard]] bool is_met_by(std::uint64_t inputs) const noexcept {
    return input >= 0 && ((inputs >> input & 1U) != 0) == value;
  }
};

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
  InputWait wait{};  ///< only of a piece that rests

  /// q and its derivatives by nominal time τ. Real-time: safe, O(n). Threads: any.
  /// @pre 0 <= tau <= duration: time is not clamped, the polynomials go on outside
  [[nodiscard]] JointState at(double tau) const noexcept;
  /// The same motion, ended at `tau`. @pre 0 < tau <= duration
  [[nodiscard]] TrajectoryPiece until(double tau) const noexcept;
  /// The same motion from `tau` on, without outputs and wait. @pre 0 <= tau < duration
  [[nodiscard]] TrajectoryPiece from(double tau) const noexcept;
};

static_assert(std::is_trivially_copyable_v<TrajectoryPiece>);

}  // namespace viapoint
