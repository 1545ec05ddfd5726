#include "viapoint/profile/axis_law.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "profile/argument_check.hpp"
#include "profile/constant_jerk.hpp"

namespace viapoint {
namespace {

/// Share of the whole by which times may differ through rounding.
constexpr double kTimeRounding = 1e-12;

/// Beyond this a sum of terms may overflow.
constexpr double kLargest = 1e307;

/// Share of their terms by which positions may differ where parts meet: far more than rounding, far
/// less than what a clock too coarse for the parts, or a coefficient that has underflown, leaves.
constexpr double kMeeting = 1e-6;

/// The terms of the part and of its derivatives at its end, by size.
AxisState sizes_of(const Polynomial& part) {
  Polynomial sizes{0.0, part.t1 - part.t0, part.c};
  for (double& c : sizes.c) c = std::abs(c);
  return sizes.at(sizes.t1);
}

/// No term of the part or of its derivatives may leave what doubles hold: then none is NaN.
void require_representable(const Polynomial& part) {
  const AxisState worst = sizes_of(part);
  for (const double size : {worst.q, worst.qd, worst.qdd, worst.qddd}) {
    if (size <= kLargest) continue;
    refuse("the law would reach " + written(size) + " between " + written(part.t0) + " and " +
               written(part.t1) + " s; position and derivatives must stay below 1e307",
           size, kLargest, {"give values nearer to one another", "give more time"});
  }
}

void require_meeting(const Polynomial& before, const Polynomial& after) {
  const double left = before.at(before.t1).q, right = after.at(after.t0).q;
  const double terms = sizes_of(before).q + sizes_of(after).q;
  if (std::abs(left - right) <= kMeeting * terms) return;
  refuse("at " + written(after.t0) + " s the law would jump from " + written(left) + " to " +
             written(right) + "; position must be continuous, within what doubles can count",
         left, right, {"begin nearer to time 0", "give shorter or longer times"});
}

std::vector<Polynomial> parts_of(const JerkProfile& profile) {
  std::vector<Polynomial> parts;
  AxisState state = profile.start;
  double t = 0.0;
  for (int i = 0; i < profile.phases; ++i) {
    const auto phase = static_cast<size_t>(i);
    const double end = t + profile.duration[phase];
    Polynomial part{0.0, profile.duration[phase], {}};
    part.c = {state.q, state.qd, 0.5 * state.qdd, profile.jerk[phase] / 6.0, 0.0, 0.0};
    // By the phase's own time: end − t would have lost bits.
    state = advanced(state, profile.jerk[phase], profile.duration[phase]);
    part.t0 = t;
    part.t1 = end;
    parts.push_back(part);
    t = end;
  }
  return parts;
}

}  // namespace

AxisLaw::AxisLaw(std::vector<Polynomial> parts) : parts_(std::move(parts)) {
  std::erase_if(parts_, [](const Polynomial& part) { return part.t1 == part.t0; });
  if (parts_.empty()) refuse("a law needs at least one part that takes time", 0.0, 1.0);
  const double slack = kTimeRounding * (std::abs(start()) + std::abs(end()));
  for (size_t i = 0; i < parts_.size(); ++i) {
    if (!(parts_[i].t1 > parts_[i].t0)) {
      refuse("part " + std::to_string(i) + " of a law lasts " +
                 written(parts_[i].t1 - parts_[i].t0) + " s; it must last longer than 0 s",
             parts_[i].t1 - parts_[i].t0, 0.0);
    }
    if (i > 0 && !(std::abs(parts_[i].t0 - parts_[i - 1].t1) <= slack)) {
      refuse("part " + std::to_string(i) + " of a law begins at " + written(parts_[i].t0) +
                 " s, but the one before ends at " + written(parts_[i - 1].t1) + " s",
             parts_[i].t0, parts_[i - 1].t1);
    }
    require_representable(parts_[i]);
    if (i > 0) require_meeting(parts_[i - 1], parts_[i]);
  }
}

AxisLaw::AxisLaw(const JerkProfile& profile) : AxisLaw(parts_of(profile)) {}

AxisState AxisLaw::at(double t) const {
  const double slack = kTimeRounding * (std::abs(start()) + std::abs(end()));
  if (!(t >= start() - slack && t <= end() + slack)) {
    refuse("time " + written(t) + " s is outside the law, which runs from " + written(start()) +
               " to " + written(end()) + " s",
           t, t < start() ? start() : end());
  }
  t = std::clamp(t, start(), end());
  const auto later = std::upper_bound(parts_.begin(), parts_.end(), t,
                                      [](double time, const Polynomial& p) { return time < p.t0; });
  return std::prev(later)->at(t);
}

Extremes AxisLaw::extremes(int derivative) const {
  Extremes all = parts_.front().extremes(derivative);
  for (const Polynomial& part : parts_) {
    const Extremes one = part.extremes(derivative);
    if (one.low < all.low) all.low = one.low, all.low_time = one.low_time;
    if (one.high > all.high) all.high = one.high, all.high_time = one.high_time;
  }
  return all;
}

}  // namespace viapoint
