/// @file
/// The real-time boundary: finished motions cross it one way, spent ones come back.
#pragma once

#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <memory>

#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/input_reaction.hpp"
#include "viapoint/realtime/interpolator.hpp"
#include "viapoint/realtime/motion_log.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// A wish, and which one it is: two steps one after the other are two wishes.
struct NumberedWish {
  std::uint32_t number = 0;
  Wish wish = Wish::kRun;
};
static_assert(std::atomic<NumberedWish>::is_always_lock_free);

/// The input that a motion waits for, as InputWait has it, in one word.
struct AwaitedInput {
  std::int16_t input = -1;
  bool value = true;
  float timeout = 0.0F;  ///< [s]

  [[nodiscard]] static AwaitedInput of(const InputWait& wait) noexcept {
    return {wait.input, wait.value, static_cast<float>(wait.timeout)};
  }
};
static_assert(std::atomic<AwaitedInput>::is_always_lock_free);

/// One motion on its way through the loop, and what both sides of the boundary say about it while
/// it runs. Owned by an ordinary thread until it has come back.
struct QueuedMotion {
  std::shared_ptr<const Trajectory> trajectory;  ///< it begins with; only ordinary threads copy it
  bool open = false;                             ///< it may get longer; constant

  std::atomic<NumberedWish> wish{};              ///< written by ordinary threads
  std::atomic<const MotionLink*> link{nullptr};  ///< by them; emptied by the tick
  /// A place for each of kReactions: written by them, emptied by the tick when it has wished.
  std::array<std::atomic<InputReaction>, kReactions.size()> reactions{};
  std::atomic<bool> closed{false};  ///< by them: an open motion gets no longer

  std::atomic<RunState> state{RunState::kRunning};  ///< the rest is written by the tick
  std::atomic<std::uint32_t> acted_on{0};           ///< number of the wish that the next goes by
  std::atomic<bool> may_be_jogged{false};           ///< at rest after a wish to pause
  std::atomic<LinkFate> fate{LinkFate::kNotYet};    ///< of the last link, before `link` is empty
  std::atomic<double> nominal_time{0.0};
  std::atomic<double> settled_time{0.0};
  std::atomic<std::int32_t> move{-1};
  std::atomic<std::uint64_t> overruns{0};
  std::atomic<std::uint64_t> missed_cycles{0};
  std::atomic<std::uint64_t> lost_records{0};
  std::atomic<std::uint64_t> waited_cycles{0};
  std::atomic<AwaitedInput> awaited{};  ///< for which it rests
  std::atomic<AwaitedInput> missed{};   ///< that did not come in time, before `state`
};

/// Bounded, lock-free, one producer and one consumer each way.
///
/// What goes through are whole motions, by pointer to their immutable pieces, and not pieces one by
/// one: every piece is in memory before its motion starts, so the tick sees as far ahead as it
/// needs to prove a stop, nothing has to be fed while the arm moves, and a late feeder cannot
/// starve it. Nothing is copied or freed on the real-time side whatever the number of pieces.
class MotionQueue {
 public:
  static constexpr int kCapacity = 8;

  /// Ordinary side. False when full.
  [[nodiscard]] bool push(QueuedMotion* motion) { return waiting_.push(motion); }
  /// Ordinary side: a motion that the tick is done with, or null.
  [[nodiscard]] QueuedMotion* take_back() {
    QueuedMotion* motion = nullptr;
    return spent_.pop(motion) ? motion : nullptr;
  }
  /// Real-time side: the next motion, or null.
  [[nodiscard]] QueuedMotion* pop() noexcept VIAPOINT_NONBLOCKING {
    QueuedMotion* motion = nullptr;
    return waiting_.pop(motion) ? motion : nullptr;
  }
  /// Real-time side. There is always room: no more can come back than fitted in.
  void give_back(QueuedMotion* motion) noexcept VIAPOINT_NONBLOCKING { spent_.push(motion); }

 private:
  using Ring = boost::lockfree::spsc_queue<QueuedMotion*, boost::lockfree::capacity<kCapacity>>;
  Ring waiting_, spent_;
};

}  // namespace viapoint
