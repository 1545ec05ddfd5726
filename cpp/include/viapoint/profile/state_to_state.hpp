/// @file
/// Several axes from state to state at once.
#pragma once

#include <array>
#include <span>

#include "viapoint/core/joint_state.hpp"
#include "viapoint/core/nonblocking.hpp"
#include "viapoint/profile/axis_move.hpp"

namespace viapoint {

/// What the axes of one motion have in common.
enum class Synchronization : unsigned char {
  kNone,  ///< nothing: each is as quick as it can be, and goes on at its end velocity
  kTime,  ///< the duration: the shortest one that all axes have a motion of
  kLine,  ///< the way: all move along the straight line from start to end, scaled by one law
};

struct StateToStateOptions {
  Synchronization synchronization = Synchronization::kTime;
  double least_duration = 0.0;  ///< [s]
  double cycle = 0.0;           ///< durations are whole multiples of this where it is > 0 [s]
};

/// The quickest motion of up to kMaxJoints axes between two states. Holds everything in place: no
/// heap. Real-time: safe. Threads: const methods.
class StateToState {
 public:
  /// Replaces the motion. A duration an axis has no motion of (it would have to come back, or could
  /// not wait) is passed over for the next one that all have.
  /// @param start, end, limits  one an axis, (n,), 1 <= n <= kMaxJoints
  /// @return kSolved, or why not; the motion is then empty, and culprit() names the axis
  [[nodiscard]] MoveStatus plan(std::span<const AxisState> start, std::span<const AxisState> end,
                                std::span<const AxisLimits> limits,
                                const StateToStateOptions& options = {}) noexcept
      VIAPOINT_NONBLOCKING;

  [[nodiscard]] int joints() const noexcept { return joints_; }
  [[nodiscard]] double duration() const noexcept { return duration_; }
  /// The axis that refused, −1 where none did.
  [[nodiscard]] int culprit() const noexcept { return culprit_; }
  /// @pre 0 <= i < joints()
  [[nodiscard]] const AxisMove& axis(int i) const noexcept { return axes_[static_cast<size_t>(i)]; }
  /// State at t, clamped to [0, duration()]. An axis that has arrived before the others (only under
  /// kNone) goes on at its end velocity, without acceleration: it rests if it ended at rest, and if
  /// not, position limits hold until its own end only.
  [[nodiscard]] JointState at(double t) const noexcept VIAPOINT_NONBLOCKING;

 private:
  [[nodiscard]] MoveStatus plan_apart(std::span<const AxisState> start,
                                      std::span<const AxisState> end,
                                      std::span<const AxisLimits> limits,
                                      const StateToStateOptions& options) noexcept;
  [[nodiscard]] MoveStatus plan_line(std::span<const AxisState> start,
                                     std::span<const AxisState> end,
                                     std::span<const AxisLimits> limits,
                                     const StateToStateOptions& options) noexcept;

  std::array<AxisMove, kMaxJoints> axes_;
  int joints_ = 0;
  int culprit_ = -1;
  double duration_ = 0.0;
};

}  // namespace viapoint
