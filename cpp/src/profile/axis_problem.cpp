#include "profile/axis_problem.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "profile/mirror_images.hpp"

namespace viapoint {
namespace {

/// Share of a limit that an end state may be over by rounding.
constexpr double kEndSlack = 1e-12;
/// Share of the way at hand within which two positions are the same but for rounding.
constexpr double kWaySlack = 1e-14;
/// What two positions lose when one is taken from the other.
constexpr double kPositionRounding = 4e-16;
/// As kWaySlack, for a duration that was solved for and comes back rounded.
constexpr double kDurationSlack = 1e-13;

bool is_sound(const AxisLimits& l) noexcept {
  return l.velocity_min < 0.0 && l.velocity_max > 0.0 && l.acceleration_min < 0.0 &&
         l.acceleration_max > 0.0 && l.jerk_min < 0.0 && l.jerk_max > 0.0 &&
         std::isfinite(l.velocity_max - l.velocity_min) &&
         std::isfinite(l.acceleration_max - l.acceleration_min) &&
         std::isfinite(l.jerk_max - l.jerk_min);
}

bool is_finite(const AxisState& s) noexcept {
  return std::isfinite(s.q) && std::isfinite(s.qd) && std::isfinite(s.qdd);
}

MoveStatus end_status(const AxisState& end, const AxisLimits& l) noexcept {
  const double span = kEndSlack * (l.velocity_max - l.velocity_min);
  if (!(end.qd <= l.velocity_max + span && end.qd >= l.velocity_min - span)) {
    return MoveStatus::kEndVelocity;
  }
  const double band = kEndSlack * (l.acceleration_max - l.acceleration_min);
  if (!(end.qdd <= l.acceleration_max + band && end.qdd >= l.acceleration_min - band)) {
    return MoveStatus::kEndAcceleration;
  }
  const double jerk = end.qdd < 0.0 ? l.jerk_min : l.jerk_max;
  const double before = end.qd - 0.5 * end.qdd * end.qdd / jerk;
  if (!(before <= l.velocity_max + span && before >= l.velocity_min - span)) {
    return MoveStatus::kEndUnreachable;
  }
  return MoveStatus::kSolved;
}

struct Brake {
  double peak, jerk_time, hold;
};

/// The way back inside when the acceleration, brought to zero at once, leaves the velocity above
/// its limit: down to −x, held if that is the limit, such that the rise from there to zero ends on
/// the velocity limit: H x² + x·hold = v + a²/2j_down − v_max.
Brake brake_down(const AxisState& s, const AxisLimits& l) noexcept {
  const double half = 0.5 * (1.0 / l.jerk_max - 1.0 / l.jerk_min);
  const double over = s.qd - 0.5 * s.qdd * s.qdd / l.jerk_min - l.velocity_max;
  const double cap = -l.acceleration_min;
  const double free = std::sqrt(std::max(0.0, over / half));
  const double x = std::max(std::min(free, cap), -s.qdd);
  const double hold = free > cap ? half * (free - cap) * (free + cap) / cap : 0.0;
  return {x, (s.qdd + x) / -l.jerk_min, hold};
}

}  // namespace

MoveStatus AxisProblem::set(const AxisState& start, const AxisState& end, const AxisLimits& limits,
                            AxisMove& move) noexcept {
  if (!is_sound(limits)) return MoveStatus::kBadLimits;
  if (!is_finite(start) || !is_finite(end) || !std::isfinite(end.q - start.q))
    return MoveStatus::kBadState;
  limits_ = limits;
  has_up_ = has_down_ = false;
  lasting_ = -1.0;
  target_q_ = end.q;
  position_rounding_ = kPositionRounding * (std::abs(start.q) + std::abs(end.q));
  rests_ = start.qd == 0.0 && start.qdd == 0.0 && end.qd == 0.0 && end.qdd == 0.0;
  if (rests_) {  // within whatever limits
    move.begin(start);
    brake_time_ = 0.0;
    from_ = move.end;
    to_ = {end.q - start.q, 0.0, 0.0, 0.0};
    return MoveStatus::kSolved;
  }
  const MoveStatus status = end_status(end, limits);
  if (status != MoveStatus::kSolved) return status;

  move.begin(start);
  AxisState& now = move.end;
  if (now.qdd > limits.acceleration_max) {
    move.append(limits.jerk_min, (limits.acceleration_max - now.qdd) / limits.jerk_min);
    now.qdd = limits.acceleration_max;
  } else if (now.qdd < limits.acceleration_min) {
    move.append(limits.jerk_max, (limits.acceleration_min - now.qdd) / limits.jerk_max);
    now.qdd = limits.acceleration_min;
  }
  const double jerk = now.qdd > 0.0 ? limits.jerk_min : limits.jerk_max;
  const double level = now.qd - 0.5 * now.qdd * now.qdd / jerk;  // once the acceleration is zero
  if (level > limits.velocity_max) {
    const Brake brake = brake_down(now, limits);
    move.append(limits.jerk_min, brake.jerk_time);
    now.qdd = -brake.peak;
    move.append(0.0, brake.hold);
  } else if (level < limits.velocity_min) {
    const Brake brake = brake_down(mirrored(now), mirrored(limits));
    move.append(limits.jerk_max, brake.jerk_time);
    now.qdd = brake.peak;
    move.append(0.0, brake.hold);
  }
  brake_time_ = move.total;
  from_ = now;
  to_ = {end.q - now.q, end.qd, end.qdd, 0.0};
  return MoveStatus::kSolved;
}

UpwardLimits AxisProblem::limits_of(bool upward) const noexcept {
  const AxisLimits& l = limits_;
  if (upward) {
    return {l.velocity_max, l.acceleration_max, -l.acceleration_min, l.jerk_max, -l.jerk_min};
  }
  return {-l.velocity_min, -l.acceleration_min, l.acceleration_max, -l.jerk_min, l.jerk_max};
}

void AxisProblem::build(bool upward) noexcept {
  if (upward && !has_up_) {
    std::construct_at(&up_, from_.qd, from_.qdd, to_.qd, to_.qdd, limits_of(true));
    has_up_ = true;
  } else if (!upward && !has_down_) {
    std::construct_at(&down_, -from_.qd, -from_.qdd, -to_.qd, -to_.qdd, limits_of(false));
    has_down_ = true;
  }
}

PhaseChain AxisProblem::chain_of(bool upward, const UpwardMember& m) const noexcept {
  const UpwardFamily& family = upward ? up_ : down_;
  const double sign = upward ? 1.0 : -1.0;
  const double rising = upward ? limits_.jerk_max : limits_.jerk_min;
  const double falling = upward ? limits_.jerk_min : limits_.jerk_max;
  const double per_up = sign / rising, per_down = -sign / falling;
  const double first = family.first_peak(m), last = family.last_peak(m);
  PhaseChain chain;
  chain.add(rising, from_.qdd, (first - sign * from_.qdd) * per_up);
  chain.add(0.0, sign * first, family.first_hold(m));
  if (m.cruise > 0.0) {
    chain.add(falling, sign * first, first * per_down);
    chain.cruise = chain.size;
    chain.top = sign * family.top();
    chain.add(0.0, 0.0, m.cruise);
    chain.add(falling, 0.0, last * per_down);
  } else {
    chain.add(falling, sign * first, m.sum * per_down);
  }
  chain.add(0.0, -sign * last, family.last_hold(m));
  chain.add(rising, -sign * last, (last + sign * to_.qdd) * per_up);
  chain.measure_from_cruise();
  return chain;
}

void AxisProblem::append_velocity_change(AxisMove& move) noexcept {
  build(true);
  append(chain_of(true, up_.quickest()), move);
  move.end.qd = to_.qd;
  move.end.qdd = to_.qdd;
}

double AxisProblem::solve_quickest() noexcept {
  if (rests_) {
    stays_ = std::abs(to_.q) <= position_rounding_;
    if (!stays_) rest_motion_.solve(std::abs(to_.q), limits_of(to_.q > 0.0));
    return quickest_.duration = stays_ ? 0.0 : rest_motion_.duration();
  }
  bool upward = to_.q > 0.0;  // a guess that is mostly right and saves the other family
  const auto family = [this](bool up) -> const UpwardFamily& {
    build(up);
    return up ? up_ : down_;
  };
  const auto sign = [&] { return upward ? 1.0 : -1.0; };
  quickest_ = family(upward).quickest();
  const double ends = (std::abs(from_.qd) + std::abs(to_.qd)) * quickest_.duration;
  const double near = kWaySlack * (std::abs(to_.q) + ends) + position_rounding_;
  const double missing = to_.q - sign() * quickest_.gain;
  if (std::abs(missing) > near) {
    const bool guessed = upward == (missing > 0.0);
    upward = missing > 0.0;
    const UpwardMember change = guessed ? quickest_ : family(upward).quickest();
    if (!family(upward).reach(sign() * to_.q, change, quickest_)) {
      // Inside the gap of gains; what is not after it is for the other family.
      if (sign() * to_.q < family(upward).after_gap().gain) upward = !upward;
      quickest_ = family(upward).reach_after_gap(sign() * to_.q);
    }
  }
  quickest_is_upward_ = upward;
  return brake_time_ + quickest_.duration;
}

void AxisProblem::append_quickest(AxisMove& move) const noexcept {
  if (rests_) {
    append_slowed(quickest_.duration, move);
    return;
  }
  append(chain_of(quickest_is_upward_, quickest_), move);
  move.end = {target_q_, to_.qd, to_.qdd, 0.0};
  if (move.phases > 0) move.total = brake_time_ + quickest_.duration;
}

void AxisProblem::solve_lasting(double t) noexcept {
  if (lasting_ == t) return;
  build(true);
  build(false);
  most_ = up_.lasting(t);
  least_ = down_.lasting(t);
  lasting_ = t;
}

double AxisProblem::next_duration(double duration) noexcept {
  if (is_rest_to_rest()) return duration;  // it can be slowed down to any
  if (duration == brake_time_ + quickest_.duration) return duration;
  double t = duration - brake_time_;
  // Each round leaves one interval of impossible durations behind; there are at most three.
  for (int round = 0; round < 4; ++round) {
    solve_lasting(t);
    if (up_.has_gap() && t > up_.gap_begin() && t < up_.gap_end()) {
      t = up_.gap_end();
      solve_lasting(t);
    }
    const double slack =
        kDurationSlack * (std::abs(to_.q) + std::abs(most_.gain) + std::abs(least_.gain) +
                          (std::abs(from_.qd) + std::abs(to_.qd)) * t);
    UpwardMember found{};
    bool before_gap = true;
    if (to_.q > most_.gain + slack) {
      before_gap = up_.reach(to_.q, most_, found);
    } else if (to_.q < -least_.gain - slack) {
      before_gap = down_.reach(-to_.q, least_, found);
    } else {
      break;
    }
    t = std::max(t, before_gap ? found.duration : up_.gap_end());
  }
  return t > duration - brake_time_ ? brake_time_ + t : duration;
}

void AxisProblem::append_lasting(double duration, AxisMove& move) noexcept {
  if (is_rest_to_rest()) {
    append_slowed(duration, move);
    return;
  }
  solve_lasting(duration - brake_time_);
  const double room = most_.gain + least_.gain;
  const double share = room > 0.0 ? (to_.q + least_.gain) / room : 1.0;
  if (share >= 1.0) {
    append(chain_of(true, most_), move);
  } else if (share <= 0.0) {
    append(chain_of(false, least_), move);
  } else {
    append_blend(share, chain_of(true, most_), chain_of(false, least_),
                 {target_q_, to_.qd, to_.qdd, 0.0}, move);
  }
  move.end = {target_q_, to_.qd, to_.qdd, 0.0};
  move.total = duration;
}

/// The quickest motion from rest to rest in slow motion: lower rates only.
void AxisProblem::append_slowed(double duration, AxisMove& move) const noexcept {
  if (stays_) {
    move.append(0.0, duration);
  } else {
    rest_motion_.write(from_.q, target_q_, to_.q > 0.0 ? 1.0 : -1.0, duration / quickest_.duration,
                       move);
  }
  move.end = {target_q_, 0.0, 0.0, 0.0};
  move.total = duration;
}

}  // namespace viapoint
