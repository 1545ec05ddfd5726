#include "profile/walled_route.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "profile/mirror_images.hpp"
#include "profile/touch.hpp"
#include "viapoint/core/scalar_minimum.hpp"

namespace viapoint {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Looks at one touch; fewer at a touch that is looked for anew for each of another one's.
constexpr int kSamples = 9, kNestedSamples = 6;
constexpr int kSteps = 24, kNestedSteps = 14;
/// Touches before the axis can rest, at either end of a calm way.
constexpr int kMostTouches = 4;

}  // namespace

RouteSearch::Leg RouteSearch::leg(const AxisState& from, const AxisState& to) const noexcept {
  AxisMove move;
  if (quickest_move(from, to, limits_, move) != MoveStatus::kSolved) return {kNever, false};
  return {move.total, walls_.hold(move)};
}

MoveStatus RouteSearch::admit_high(Walls& walls, const AxisState& from, const AxisState& to,
                                   const AxisLimits& limits) const noexcept {
  const double most = std::max(walls.high, from.q > walls.high ? walls.start_high : walls.high);
  if (approaches(from, limits)) {
    const double peak = least_peak(from, limits);
    if (peak > most + walls.slack) return MoveStatus::kStartTooFast;
    if (from.q <= walls.high) walls.high = std::max(walls.high, peak);
  }
  const AxisState back = reversed(to);
  if (approaches(back, reversed(limits))) {
    const double peak = least_peak(back, reversed(limits));
    if (peak > walls.high + walls.slack) return MoveStatus::kEndTooFast;
    walls.high = std::max(walls.high, peak);
  }
  return MoveStatus::kSolved;
}

MoveStatus RouteSearch::admit(Walls& walls, const AxisState& from,
                              const AxisState& to) const noexcept {
  MoveStatus status = admit_high(walls, from, to, limits_);
  if (status != MoveStatus::kSolved) return status;
  Walls low = mirrored(walls);
  status = admit_high(low, mirrored(from), mirrored(to), mirrored(limits_));
  walls = mirrored(low);
  return status;
}

Route RouteSearch::quickest(double budget) const noexcept {
  const Touches touches = search(from_, to_, 2, budget, false);
  Route route{};
  route.rest = -1;
  route.stops = touches.count;
  for (int i = 0; i < touches.count; ++i) {
    route.stop[static_cast<size_t>(i)] = touches.at[static_cast<size_t>(i)];
  }
  route.duration = touches.count > 0 ? touches.duration : kNever;
  return route;
}

/// Walls only make a leg longer: what takes too long without them need not be looked into.
RouteSearch::Touches RouteSearch::through(const AxisState& from, const AxisState& touch,
                                          const AxisState& to, int most, double budget,
                                          double& bound) const noexcept {
  const Touches none{{}, 0, kNever};
  const Leg first = leg(from, touch);
  if (!(first.duration < budget)) return none;
  const Leg second = leg(touch, to);
  const double total = first.duration + second.duration;
  if (first.holds && second.holds) return {{touch}, 1, total};
  if (!(total < budget) || first.holds == second.holds) return none;
  bound = std::min(bound, total);
  if (most < 2) return none;
  const Touches more = first.holds ? search(touch, to, 1, budget - first.duration, true)
                                   : search(from, touch, 1, budget - second.duration, true);
  if (more.count == 0) return none;
  if (first.holds) return {{touch, more.at[0]}, 2, first.duration + more.duration};
  return {{more.at[0], touch}, 2, more.duration + second.duration};
}

RouteSearch::Touches RouteSearch::search(const AxisState& from, const AxisState& to, int most,
                                         double budget, bool nested) const noexcept {
  const int samples = nested ? kNestedSamples : kSamples;
  const int steps = nested ? kNestedSteps : kSteps;
  Touches best{{}, 0, budget};
  Walls walls = walls_;
  if (admit(walls, from, to) != MoveStatus::kSolved) return best;
  AxisMove free;
  if (quickest_move(from, to, limits_, free) != MoveStatus::kSolved) return best;
  const AxisMove::Extent extent = free.extent();
  struct Range {
    bool upper;
    double hardest, gentlest, bound;
  };
  std::array<Range, 4> ranges;
  size_t count = 0;
  for (const bool upper : {true, false}) {
    const bool is_left = upper ? extent.high > walls_.high : extent.low < walls_.low;
    if (!is_left) continue;
    const AxisLimits limits = upper ? limits_ : mirrored(limits_);
    const AxisState start = upper ? from : mirrored(from);
    const AxisState end = reversed(upper ? to : mirrored(to));
    const double wall = upper ? walls_.high : -walls_.low;
    const auto add = [&](double hardest, double gentlest) {
      if (hardest <= gentlest) ranges[count++] = {upper, hardest, gentlest, -kNever};
    };
    TouchRange coming{hardest_touch(limits), 0.0, false, true}, going = coming;
    const bool comes = start.q <= wall && approaches(start, limits);
    const bool goes = approaches(end, reversed(limits));
    if (comes) coming = touch_range(start, limits, wall);
    if (goes) going = touch_range(end, reversed(limits), wall);
    const double hardest = std::max(coming.hardest, going.hardest);
    const double gentlest = std::min(coming.gentlest, going.gentlest);
    if (hardest <= gentlest) {
      add(hardest, gentlest);
    } else {
      add(coming.hardest, coming.gentlest);
      add(going.hardest, going.gentlest);
    }
  }
  // First with one touch alone, then with another where that may still be quicker.
  for (int touches = 1; touches <= most; ++touches) {
    for (Range& range : std::span(ranges).first(count)) {
      if (!(range.bound < best.duration)) continue;
      range.bound = kNever;
      const double sign = range.upper ? 1.0 : -1.0;
      const double wall = range.upper ? walls_.high : walls_.low;
      (void)least_of(range.hardest, range.gentlest, samples, steps, [&](double acceleration) {
        const AxisState touch{wall, 0.0, sign * acceleration, 0.0};
        const Touches now = through(from, touch, to, touches, best.duration, range.bound);
        if (now.count > 0 && now.duration < best.duration) best = now;
        return now.count == touches ? now.duration : kNever;
      });
    }
  }
  return best;
}

int RouteSearch::come_to_rest(AxisState from, const AxisLimits& limits, const Walls& walls,
                              AxisState* stop) noexcept {
  for (int touches = 0; touches <= kMostTouches; ++touches) {
    AxisMove move;
    if (quickest_velocity_change(from, {}, limits, move) != MoveStatus::kSolved) return -1;
    if (walls.hold(move)) {
      stop[touches] = {move.end.q, 0.0, 0.0, 0.0};
      return touches + 1;
    }
    const bool upper = move.extent().high > walls.high;
    const AxisLimits l = upper ? limits : mirrored(limits);
    const AxisState s = upper ? from : mirrored(from);
    const double wall = upper ? walls.high : -walls.low;
    if (!approaches(s, l) || !(s.q <= wall)) return -1;
    const TouchRange range = touch_range(s, l, wall);
    if (!range.possible || touches == kMostTouches) return -1;
    from = {wall, 0.0, range.gentlest, 0.0};
    if (!upper) from = mirrored(from);
    stop[touches] = from;
  }
  return -1;
}

Route RouteSearch::calm() const noexcept {
  Route route{};
  route.duration = kNever;
  std::array<AxisState, kMostTouches + 1> before, after;
  const int coming = come_to_rest(from_, limits_, walls_, before.data());
  const int going = come_to_rest(reversed(to_), reversed(limits_), walls_, after.data());
  if (coming < 0 || going < 0) return route;
  route.stops = 0;
  for (int i = 0; i < coming; ++i) {
    route.stop[static_cast<size_t>(route.stops++)] = before[static_cast<size_t>(i)];
  }
  route.rest = coming - 1;
  for (int i = going - 1; i >= 0; --i) {
    route.stop[static_cast<size_t>(route.stops++)] = reversed(after[static_cast<size_t>(i)]);
  }
  double duration = 0.0;
  AxisState here = from_;
  for (int i = 0; i <= route.stops; ++i) {
    const AxisState& next = i < route.stops ? route.stop[static_cast<size_t>(i)] : to_;
    const Leg way = leg(here, next);
    duration += way.holds ? way.duration : kNever;
    here = next;
  }
  route.duration = duration;
  return route;
}

}  // namespace viapoint
