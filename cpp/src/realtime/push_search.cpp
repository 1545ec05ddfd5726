#include "viapoint/realtime/push_search.hpp"

#include <algorithm>

namespace viapoint {
namespace {

/// First step down from 1, and the difference that a search is not gone on with for.
constexpr double kGap = 1.0 / 128.0;
/// From here down a share that has no way back is halved, above it its distance from 1 is doubled.
constexpr double kFar = 0.75;
/// Least share that is tried after others had no way back.
constexpr double kLeast = 1.0 / 64.0;

}  // namespace

PushSearch::PushSearch(const Memory& last, double missing) noexcept VIAPOINT_NONBLOCKING
    : missing_(missing),
      share_(last.strength),
      strength_(last.strength) {
  if (last.gain > missing) share_ *= missing / last.gain;
}

void PushSearch::refuse() noexcept VIAPOINT_NONBLOCKING {
  if (low_ == 0.0 && share_ <= kLeast) goes_on_ = false;
  high_ = share_;
  above_ = Above::kNoWayBack;
  strength_ = std::max(low_, kLeast);
  choose_next();
}

void PushSearch::go_too_far(double gain) noexcept VIAPOINT_NONBLOCKING {
  high_ = share_;
  // The rate may go too far on the way and come back: as far as that says nothing of the gain.
  high_gain_ = gain > missing_ ? gain : 2.0 * missing_;
  above_ = Above::kTooFar;
  was_low_ = false;
  choose_next();
}

void PushSearch::accept(double gain) noexcept VIAPOINT_NONBLOCKING {
  low_ = share_;
  low_gain_ = gain;
  strength_ = std::max(strength_, low_);
  if (gain >= missing_ - kSameGain || low_ >= 1.0) goes_on_ = false;
  // Too little twice in turn: the chord's far end has stayed, and is brought nearer.
  if (above_ == Above::kTooFar && was_low_) high_gain_ = 0.5 * (high_gain_ + missing_);
  was_low_ = true;
  choose_next();
}

void PushSearch::choose_next() noexcept VIAPOINT_NONBLOCKING {
  switch (above_) {
    case Above::kNothing:
      share_ = low_ < 0.5 ? std::max(2.0 * low_, kLeast) : std::min(1.0, 0.5 * (1.0 + low_) + kGap);
      return;
    case Above::kTooFar:
      share_ = low_ + (high_ - low_) * (missing_ - low_gain_) / (high_gain_ - low_gain_);
      return;
    case Above::kNoWayBack:
      if (low_ > 0.0) {
        if (high_ - low_ <= 2.0 * kGap) goes_on_ = false;
        share_ = 0.5 * (low_ + high_);
      } else {
        share_ = share_ > kFar ? 1.0 - 2.0 * std::max(kGap, 1.0 - share_) : 0.5 * share_;
        share_ = std::max(share_, kLeast);
      }
      return;
  }
}

}  // namespace viapoint
