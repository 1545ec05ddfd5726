/// @file
/// What a run does when the world answers.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/interpolator.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// A wish that the loop makes by itself, in the cycle after the drive has reported an input so. It
/// does so once; an input that is so already counts.
struct InputReaction {
  std::int16_t input = -1;   ///< 0 to 63; -1 for none
  bool value = true;         ///< on or off
  Wish wish = Wish::kPause;  ///< kPause, kRun or kStop

  /// @param inputs as the drive reports them, bit i for input i
  [[nodiscard]] bool is_met_by(std::uint64_t inputs) const noexcept VIAPOINT_NONBLOCKING {
    return input >= 0 && ((inputs >> input & 1U) != 0) == value;
  }
};
static_assert(std::atomic<InputReaction>::is_always_lock_free);

/// What a reaction may wish, in the order in which those of one cycle are acted on: the safer ones
/// last, so that they count. What an operator wishes in that cycle comes after the first.
inline constexpr std::array kReactions = {Wish::kRun, Wish::kPause, Wish::kStop};

}  // namespace viapoint
