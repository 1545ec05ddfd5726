/// @file
/// The motions that a run has been lengthened by, as one.
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <memory>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/realtime/motion_link.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// Keeps what lies ahead of the arm, and behind it as much as it may go back over; so its memory
/// does not grow with the run. Times are nominal ones since the run began unless told otherwise.
/// Real-time: not. Threads: one at a time, but for duration().
class MotionChain {
 public:
  MotionChain(std::shared_ptr<const Trajectory> first, const JointLimits& limits);

  /// The chain with `next`, which begins when the motion before is left at `leave` [s of that
  /// one's time]; it counts once it has been settled.
  /// @param now where the arm has got to
  /// @returns what the tick is to be told; it lives until the link after it has been made
  /// @throws MotionError: what `next`, or the step to it, does not keep
  const MotionLink* lengthen(const Trajectory& next, double leave, double now);
  /// What became of the last link.
  void settle(LinkFate fate);

  /// True where there is no link whose fate is open.
  [[nodiscard]] bool is_settled() const { return offered_.motion == nullptr; }
  /// Of all that has been taken up.
  [[nodiscard]] double duration() const { return duration_.load(std::memory_order_relaxed); }
  /// When the motion taken up last begins.
  [[nodiscard]] double last_start() const { return present_.last_start; }

  /// Pieces behind the arm that are kept at most.
  static constexpr std::size_t kKept = 128;

 private:
  /// A motion and where it stands in the run.
  struct Link {
    std::shared_ptr<const Trajectory> motion;
    double start = 0.0;              ///< of the motion
    double last_start = 0.0;         ///< of what was handed over last
    std::deque<std::size_t> rested;  ///< pieces that begin at rest
    MotionLink told;
  };

  /// First piece that is kept, from which on the arm may go back and forth.
  [[nodiscard]] std::size_t first_kept(std::size_t piece_now, std::size_t piece_left) const;

  JointLimits limits_;
  Link present_, offered_;
  std::atomic<double> duration_;
};

}  // namespace viapoint
