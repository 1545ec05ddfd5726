#include "profile/move_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace viapoint {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
/// Share of the size of a move by which it may be beyond a wall, and the positions' own rounding.
constexpr double kWallSlack = 1e-10;
constexpr double kPositionRounding = 1e-15;
/// Durations looked at for one that stays between the walls, and halvings of what is left then.
constexpr int kProbes = 8;
constexpr int kHalvings = 12;
/// Share of a duration up to which longer ones are looked at where the axis cannot rest.
constexpr double kLongest = 4.0;
/// How often that is done before the axis asks for as much time as it needs to rest in between.
constexpr int kSearches = 2;

/// The phases of `leg` after those of `whole`; false where they are too many.
bool join(const AxisMove& leg, AxisMove& whole) noexcept {
  if (whole.phases + leg.phases > AxisMove::kMaxPhases) return false;
  for (int i = 0; i < leg.phases; ++i) {
    whole.phase[static_cast<size_t>(whole.phases++)] = leg.phase[static_cast<size_t>(i)];
  }
  whole.total += leg.total;
  whole.end = leg.end;
  return true;
}

}  // namespace

MoveStatus MoveProblem::solve(const AxisState& start, const AxisState& end,
                              const AxisLimits& limits, AxisMove& move) noexcept {
  const double low = limits.position_min, high = limits.position_max;
  if (!(low <= high && low < kNone && high > -kNone)) return MoveStatus::kBadLimits;
  const MoveStatus status = free_.set(start, end, limits, move);
  if (status != MoveStatus::kSolved) return status;
  duration_ = free_.solve_quickest();
  has_walls_ = low > -kNone || high < kNone;
  if (!has_walls_) return status;
  std::construct_at(&between_.value);
  between_.value.to = end;
  return solve_between_walls(start, limits, move);
}

MoveStatus MoveProblem::solve_between_walls(const AxisState& start, const AxisLimits& limits,
                                            const AxisMove& begun) noexcept {
  between_.value.has_calm = false;
  between_.value.searches = 0;
  between_.value.limits = limits;
  between_.value.limits.position_min = -kNone;
  between_.value.limits.position_max = kNone;
  between_.value.from = begun.end;
  between_.value.begun = begun.total;

  AxisMove free = begun;
  free_.append_quickest(free);
  const AxisMove::Extent extent = free.extent();
  const double low = limits.position_min, high = limits.position_max;
  between_.value.walls = {
      low, high,
      kWallSlack * (extent.high - extent.low) +
          kPositionRounding * (std::abs(start.q) + std::abs(between_.value.to.q)),
      low, high};
  if (!(between_.value.to.q <= high + between_.value.walls.slack &&
        between_.value.to.q >= low - between_.value.walls.slack)) {
    return MoveStatus::kEndPosition;
  }
  if (start.q > high + between_.value.walls.slack || start.q < low - between_.value.walls.slack) {
    AxisMove stop;
    const MoveStatus status = quickest_velocity_change(start, {}, between_.value.limits, stop);
    if (status != MoveStatus::kSolved) return status;
    const AxisMove::Extent reach = stop.extent();
    between_.value.walls.start_low = std::min(low, reach.low);
    between_.value.walls.start_high = std::max(high, reach.high);
  }
  if (!between_.value.walls.hold(begun)) return MoveStatus::kStartTooFast;
  between_.value.route.stops = 0;
  if (between_.value.walls.hold(free)) return MoveStatus::kSolved;

  RouteSearch search(between_.value.from, between_.value.to, between_.value.limits,
                     between_.value.walls);
  const MoveStatus status = search.admit();
  if (status != MoveStatus::kSolved) return status;
  between_.value.walls = search.walls();
  between_.value.calm = search.calm();
  between_.value.route = search.quickest(between_.value.calm.duration);
  between_.value.has_calm = true;
  if (!(between_.value.route.duration <= between_.value.calm.duration))
    between_.value.route = between_.value.calm;
  if (!std::isfinite(between_.value.route.duration)) return MoveStatus::kNoRoom;
  duration_ = between_.value.begun + between_.value.route.duration;
  return MoveStatus::kSolved;
}

bool MoveProblem::append_quickest(AxisMove& move) const noexcept {
  if (has_walls_ && between_.value.route.stops > 0) {
    if (!append_route(between_.value.route, -1, 0.0, move)) return false;
    move.total = duration_;
  } else {
    free_.append_quickest(move);
  }
  return true;
}

bool MoveProblem::append_route(const Route& route, int stretched, double more,
                               AxisMove& move) const noexcept {
  AxisState here = between_.value.from;
  for (int i = 0; i <= route.stops; ++i) {
    const AxisState& next =
        i < route.stops ? route.stop[static_cast<size_t>(i)] : between_.value.to;
    AxisProblem problem;
    AxisMove leg;
    if (problem.set(here, next, between_.value.limits, leg) != MoveStatus::kSolved) return false;
    const double quickest = problem.solve_quickest();
    const double wanted = i == stretched ? quickest + more : quickest;
    if (wanted == quickest) {
      problem.append_quickest(leg);
    } else if (problem.next_duration(wanted) == wanted) {
      problem.append_lasting(wanted, leg);
    } else {
      return false;
    }
    if (!join(leg, move)) return false;
    if (stretched < 0 && more > 0.0 && i == route.rest) {
      if (move.phases == AxisMove::kMaxPhases) return false;
      move.append(0.0, more);
    }
    here = next;
  }
  return true;
}

const Route& MoveProblem::calm() noexcept {
  if (!between_.value.has_calm) {
    RouteSearch search(between_.value.from, between_.value.to, between_.value.limits,
                       between_.value.walls);
    // The walls may have to give way to rounding.
    if (search.admit() == MoveStatus::kSolved) {
      between_.value.calm = search.calm();
    } else {
      between_.value.calm.duration = kNone;
    }
  }
  between_.value.has_calm = true;
  return between_.value.calm;
}

bool MoveProblem::find_stretched(double more, AxisMove& move) const noexcept {
  const AxisMove begun = move;
  for (int leg = between_.value.route.stops; leg >= 0; --leg) {
    if (append_route(between_.value.route, leg, more, move) &&
        between_.value.walls.hold(move, begun.phases))
      return true;
    move = begun;
  }
  return false;
}

bool MoveProblem::find_lasting(double duration, AxisMove& move) noexcept {
  const AxisMove begun = move;
  bool found = false;
  if (free_.next_duration(duration) == duration) {
    free_.append_lasting(duration, move);
    found = between_.value.walls.hold(move, begun.phases);
    if (!found) move = begun;
  }
  if (!found && between_.value.route.stops > 0) found = find_stretched(duration - duration_, move);
  if (!found && duration >= between_.value.begun + calm().duration) {
    found = append_route(between_.value.calm, -1,
                         duration - between_.value.begun - between_.value.calm.duration, move);
    if (!found) move = begun;
  }
  if (found) move.total = duration;
  return found;
}

double MoveProblem::next_duration(double duration, const AxisMove& begun) noexcept {
  if (!has_walls_) return free_.next_duration(duration);
  if (duration == duration_ || free_.is_rest_to_rest()) return duration;
  AxisMove scratch = begun;
  if (find_lasting(duration, scratch)) return duration;
  // From the calm way's on all last. An axis that is too fast to rest anywhere has none.
  const double calm_duration = between_.value.begun + calm().duration;
  const bool can_rest = std::isfinite(calm_duration);
  if (can_rest && duration >= calm_duration) return kNone;
  const double last = can_rest ? calm_duration : kLongest * duration;
  if (++between_.value.searches > kSearches) return can_rest ? last : kNone;
  double bad = duration, good = can_rest ? last : kNone;
  for (int i = 1; i < kProbes; ++i) {
    const double t = duration + (last - duration) * i / kProbes;
    scratch = begun;
    if (find_lasting(t, scratch)) {
      good = t;
      break;
    }
    bad = t;
  }
  if (good == kNone) return good;
  for (int i = 0; i < kHalvings; ++i) {
    const double t = 0.5 * (bad + good);
    scratch = begun;
    (find_lasting(t, scratch) ? good : bad) = t;
  }
  return good;
}

bool MoveProblem::append_lasting(double duration, AxisMove& move) noexcept {
  if (has_walls_ && !free_.is_rest_to_rest()) return find_lasting(duration, move);
  free_.append_lasting(duration, move);
  return true;
}

}  // namespace viapoint
