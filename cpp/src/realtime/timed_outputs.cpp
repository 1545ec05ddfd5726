#include "viapoint/realtime/timed_outputs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace viapoint {
namespace {

/// Nearer than this a time is reached [s].
constexpr double kSlack = 1e-9;
/// Of a cycle: a time this near to so many cycles is so many.
constexpr double kWholeCycles = 1e-6;

}  // namespace

TimedOutputs::TimedOutputs(double cycle)
    : cycle_(cycle), farthest_(static_cast<std::size_t>(kMostOutputTime / cycle) + 3) {}

void TimedOutputs::begin(const TimedChanges& changes,
                         std::uint64_t outputs) noexcept VIAPOINT_NONBLOCKING {
  changes_ = &changes;
  next_ = {};
  outputs_ = outputs;
  left_out_ = 0.0;
  cycles_ = 0;
}

void TimedOutputs::lengthen(const TimedChanges& changes, std::size_t dropped, double shift,
                            double farthest, std::uint64_t outputs) noexcept VIAPOINT_NONBLOCKING {
  for (std::uint64_t left = changes.outputs(); left != 0; left &= left - 1) {
    const int output = std::countr_zero(left);
    std::size_t& next = next_[static_cast<std::size_t>(output)];
    if ((mask() >> output & 1U) != 0) {
      // The changes that both have in common come in the same order.
      const auto before = changes_->of(output);
      const auto kept = std::ranges::lower_bound(before, dropped, {}, &TimedChange::piece);
      next -= std::min(next, static_cast<std::size_t>(kept - before.begin()));
    } else {
      // So far each has changed where it is passed.
      const auto all = changes.of(output);
      next = static_cast<std::size_t>(
          std::ranges::upper_bound(all, farthest - shift, {}, &TimedChange::place) - all.begin());
    }
  }
  changes_ = &changes;
  outputs_ = outputs;
  left_out_ += shift;
}

std::uint64_t TimedOutputs::tick(const Progress& progress,
                                 const RateGovernor& governor) noexcept VIAPOINT_NONBLOCKING {
  farthest_[cycles_++ % farthest_.size()] = left_out_ + progress.farthest;
  for (std::uint64_t left = mask(); left != 0; left &= left - 1) {
    const int output = std::countr_zero(left);
    const auto all = changes_->of(output);
    std::size_t& next = next_[static_cast<std::size_t>(output)];
    const auto due = [&](const TimedChange& change) { return is_due(change, progress, governor); };
    if (next >= all.size() || !due(all[next])) continue;
    // However many were passed in this cycle, the last of them is what counts.
    const auto rest = all.subspan(next + 1);
    const auto end = std::partition_point(rest.begin(), rest.end(), due);
    next += 1 + static_cast<std::size_t>(end - rest.begin());
    set(output, all[next - 1].value);
  }
  return outputs_;
}

std::uint64_t TimedOutputs::end() noexcept VIAPOINT_NONBLOCKING {
  for (std::uint64_t left = mask(); left != 0; left &= left - 1) {
    const int output = std::countr_zero(left);
    const auto all = changes_->of(output);
    std::size_t& next = next_[static_cast<std::size_t>(output)];
    if (next < all.size()) set(output, all.back().value);
    next = all.size();
  }
  return outputs_;
}

bool TimedOutputs::is_due(const TimedChange& change, const Progress& progress,
                          const RateGovernor& governor) const noexcept VIAPOINT_NONBLOCKING {
  if (change.time > 0.0) {
    return farthest_before(change.time) >= left_out_ + change.place - kSlack;
  }
  if (change.place <= progress.farthest) return true;
  const double lead = -change.time;
  // At no rate it gets farther.
  if (!progress.is_ahead || change.place > progress.now.tau + lead + kSlack) return false;
  const double there = governor.after(progress.now, lead).tau;
  return std::min(there, progress.until) >= change.place - kSlack;
}

/// How far the arm had got `time` [s] of the clock ago.
double TimedOutputs::farthest_before(double time) const noexcept VIAPOINT_NONBLOCKING {
  double ago = time / cycle_;
  if (std::abs(ago - std::round(ago)) < kWholeCycles) ago = std::round(ago);
  const auto whole = static_cast<std::size_t>(ago);
  const double part = ago - static_cast<double>(whole);
  const std::size_t oldest = whole + (part > 0.0 ? 1 : 0);
  if (oldest >= cycles_) return -std::numeric_limits<double>::infinity();
  const double later = farthest_[(cycles_ - 1 - whole) % farthest_.size()];
  const double earlier = farthest_[(cycles_ - 1 - oldest) % farthest_.size()];
  return later + part * (earlier - later);
}

void TimedOutputs::set(int output, bool value) noexcept VIAPOINT_NONBLOCKING {
  const std::uint64_t bit = std::uint64_t{1} << output;
  outputs_ = value ? outputs_ | bit : outputs_ & ~bit;
}

}  // namespace viapoint
