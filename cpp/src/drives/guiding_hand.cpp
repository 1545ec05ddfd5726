#include "viapoint/drives/guiding_hand.hpp"

#include <utility>

#include "viapoint/core/error.hpp"

namespace viapoint {

void GuidingHand::guide(std::vector<JointVector> positions) {
  if (positions.empty()) {
    throw MotionError(ErrorCode::kBadArgument, "a hand that guides needs at least one position");
  }
  const std::lock_guard lock(mutex_);
  if (guides()) {
    throw MotionError(ErrorCode::kBusy, "a hand guides the arm already",
                      {"wait until it has let go of it"});
  }
  positions_ = std::move(positions);
  next_ = 0;
  lets_go_.store(false, std::memory_order_relaxed);
  guides_.store(true, std::memory_order_release);
}

bool GuidingHand::take(JointVector& q) noexcept {
  if (!guides_.load(std::memory_order_acquire)) return false;
  if (next_ == positions_.size() || lets_go_.load(std::memory_order_acquire)) {
    guides_.store(false, std::memory_order_release);
    return false;
  }
  q = positions_[next_++];
  return true;
}

}  // namespace viapoint
