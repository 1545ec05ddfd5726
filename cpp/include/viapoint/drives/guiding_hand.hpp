/// @file
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint {

/// A hand that moves a simulated arm: it takes the arm through positions, one a cycle, and lets go
/// of it at the last. One thread guides, the loop's thread is guided; neither waits for the other.
class GuidingHand {
 public:
  /// Takes hold of the arm in the next cycle. Where a loop runs the arm: in its admit_hand().
  /// @param positions each (n,) [rad or m], the first one where the arm stands
  /// @throws MotionError(kBadArgument) for none; kBusy while the hand guides already
  /// Real-time: not. Threads: any.
  void guide(std::vector<JointVector> positions);
  /// Lets go of the arm in the next cycle. Real-time: safe. Threads: any.
  void let_go() noexcept { lets_go_.store(true, std::memory_order_release); }
  /// Real-time: safe. Threads: any.
  [[nodiscard]] bool guides() const noexcept { return guides_.load(std::memory_order_acquire); }

  /// The position of this cycle; false, and `q` as it was, where the hand is off the arm.
  /// Real-time: safe. Threads: the loop's.
  [[nodiscard]] bool take(JointVector& q) noexcept;

 private:
  std::mutex mutex_;                    ///< of those who guide
  std::vector<JointVector> positions_;  ///< written only while `guides_` is false
  std::size_t next_ = 0;                ///< likewise, and then the loop's
  std::atomic<bool> guides_{false};
  std::atomic<bool> lets_go_{false};
};

}  // namespace viapoint
