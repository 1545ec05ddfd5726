/// @file
/// Which push to try next, by what became of those tried before.
#pragma once

#include "viapoint/core/nonblocking.hpp"

namespace viapoint {

/// Looks for the push that gains most of what is missing, and no more. Pushes are shares of the
/// strongest one that the joints allow for a cycle; what one gains is found out by trying.
///
/// It begins with what the last search ended with, goes up from what has a way back and down from
/// what has none, nearly 1 in small steps: where a limit is followed, a little less than the
/// strongest is what can be held, and much less would let go of it. Between two pushes of which one
/// gains too little and one too much it goes by the chord, as in the Illinois method (Dowell &
/// Jarratt 1971). Real-time: safe. Threads: one.
class PushSearch {
 public:
  /// What one search leaves to the next.
  struct Memory {
    double strength = 1.0;  ///< share that has had a way back
    double gain = 0.0;      ///< by the push that was chosen
  };

  /// @param missing all there is to gain, > 0
  PushSearch(const Memory& last, double missing) noexcept VIAPOINT_NONBLOCKING;

  /// The share to be tried, in (0, 1].
  [[nodiscard]] double share() const noexcept { return share_; }
  /// False where nothing better is to be expected.
  [[nodiscard]] bool goes_on() const noexcept { return goes_on_; }
  [[nodiscard]] Memory memory() const noexcept { return {strength_, low_gain_}; }

  /// What became of the share: it has no way back.
  void refuse() noexcept VIAPOINT_NONBLOCKING;
  /// It gains more than is missing, or its rate goes beyond on the way.
  void go_too_far(double gain) noexcept VIAPOINT_NONBLOCKING;
  /// It has a way back, and is the best so far.
  void accept(double gain) noexcept VIAPOINT_NONBLOCKING;

  /// Gains that differ by less are the same.
  static constexpr double kSameGain = 1e-12;

 private:
  /// What is known of shares above the best so far.
  enum class Above { kNothing, kNoWayBack, kTooFar };

  void choose_next() noexcept VIAPOINT_NONBLOCKING;

  double missing_, share_, strength_;
  double low_ = 0.0, low_gain_ = 0.0;  ///< the best so far
  double high_ = 1.0, high_gain_ = 0.0;
  Above above_ = Above::kNothing;
  bool was_low_ = false;  ///< the last one tried was too little
  bool goes_on_ = true;
};

}  // namespace viapoint
