#include "viapoint/realtime/rate_governor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace viapoint {
namespace {

/// Rates that differ by less are the same: a step of this size is far below every limit's slack.
constexpr double kSameRate = 1e-12;
/// Largest change of the rate in a cycle, and cycles to get there, where the joints would allow
/// more (at rest they allow anything).
constexpr double kMaxRateStep = 1.0;
constexpr double kCyclesToMaxSlope = 1.0;
/// Outside of [0, 1] by more than this, the end of a way back says nothing any more.
constexpr double kFarOutside = 0.5;
Range hull(double a, double b) noexcept { return {std::min(a, b), std::max(a, b)}; }

Range within_unit(const Range& rate) noexcept {
  return {std::clamp(rate.low, 0.0, 1.0), std::clamp(rate.high, 0.0, 1.0)};
}

/// Rates between two states with a constant γ between them.
Range rates_between(const RateState& from, const RateState& to, double gamma) noexcept {
  Range rate = hull(from.rate, to.rate);
  if (from.slope * to.slope < 0.0) {
    const double turn = from.rate - 0.5 * from.slope * from.slope / gamma;
    rate.low = std::min(rate.low, turn);
    rate.high = std::max(rate.high, turn);
  }
  return rate;
}

bool leaves_unit(const Range& rate) noexcept {
  return !(rate.low >= -kSameRate && rate.high <= 1.0 + kSameRate);
}

}  // namespace

RateGovernor::RateGovernor(const JointLimits& limits, double cycle)
    : limits_(limits),
      cycle_(cycle),
      max_slope_(kMaxRateStep / cycle),
      max_curvature_(max_slope_ / (kCyclesToMaxSlope * cycle)) {
  // How long the slowest joint takes to build up its acceleration, or to turn round a rate under a
  // jerk that the motion itself uses up (a quarter swing of ρ'' = -3 J/v ρ).
  double longest = 0.0;
  for (int i = 0; i < limits.joints(); ++i) {
    longest = std::max({longest, limits.acceleration[i] / limits.jerk[i],
                        std::sqrt(limits.velocity[i] / limits.jerk[i])});
  }
  constexpr double kWayBack = 1.5;
  constexpr double kMaxStride = 64.0;
  int cycles = 0;
  stride_ = 1;
  for (int step = 0; step < kSteps; ++step) cycles += longest_step(step);
  stride_ = static_cast<int>(
      std::clamp(std::ceil(kWayBack * longest / (cycles * cycle)), 1.0, kMaxStride));
}

double RateGovernor::cell() const noexcept { return 0.5 * stride_ * cycle_; }

void RateGovernor::reset() noexcept VIAPOINT_NONBLOCKING {
  plan_.steps = 0;
  plan_.position = 0;
  memory_ = {};
}

double RateGovernor::decide(const RateState& now, double target,
                            const Lookahead& lookahead) noexcept VIAPOINT_NONBLOCKING {
  wanted_ = target;
  const double end = changing() ? plan_.end_rate : now.rate;
  if (std::abs(target - end) > kSameRate) improve(now, target, lookahead);
  return keep();
}

double RateGovernor::keep() const noexcept {
  return changing() ? plan_.step[static_cast<std::size_t>(plan_.position)].curvature : 0.0;
}

RateState RateGovernor::advance(const RateState& now) noexcept VIAPOINT_NONBLOCKING {
  if (!changing()) return now.after(cycle_, 0.0);
  Step& step = plan_.step[static_cast<std::size_t>(plan_.position)];
  RateState next = now.after(cycle_, step.curvature);
  if (--step.cycles == 0) ++plan_.position;
  if (!changing()) {
    next.slope = 0.0;
    next.rate = std::abs(plan_.end_rate - wanted_) <= kSameRate ? wanted_ : plan_.end_rate;
  }
  next.rate = std::clamp(next.rate, 0.0, 1.0);
  next.tau = std::max(next.tau, now.tau);  // rounding, at a rate of next to nothing
  return next;
}

double RateGovernor::settled_at(const RateState& now) const noexcept VIAPOINT_NONBLOCKING {
  RateState state = now;
  for (int k = plan_.position; k < plan_.steps; ++k) {
    const Step& step = plan_.step[static_cast<std::size_t>(k)];
    state = state.after(step.cycles * cycle_, step.curvature);
  }
  return std::max(now.tau, state.tau);
}

double RateGovernor::time_to(const RateState& now, double tau) const noexcept VIAPOINT_NONBLOCKING {
  RateState state = now;
  double time = 0.0;
  for (int k = plan_.position; k < plan_.steps; ++k) {
    const Step& step = plan_.step[static_cast<std::size_t>(k)];
    const double part = step.cycles * cycle_;
    const RateState next = state.after(part, step.curvature);
    if (next.tau >= tau) return time + part * (tau - state.tau) / (next.tau - state.tau);
    time += part;
    state = next;
  }
  const double rate = changing() ? plan_.end_rate : now.rate;
  return rate > 0.0 ? time + (tau - state.tau) / rate : std::numeric_limits<double>::infinity();
}

RateState RateGovernor::after(const RateState& now,
                              double time) const noexcept VIAPOINT_NONBLOCKING {
  RateState state = now;
  for (int k = plan_.position; k < plan_.steps && time > 0.0; ++k) {
    const Step& step = plan_.step[static_cast<std::size_t>(k)];
    const double part = std::min(time, step.cycles * cycle_);
    state = state.after(part, step.curvature);
    time -= part;
  }
  if (time > 0.0) state = RateState{state.tau, state.rate, 0.0}.after(time, 0.0);
  return state;
}

void RateGovernor::improve(const RateState& now, double target,
                           const Lookahead& lookahead) noexcept VIAPOINT_NONBLOCKING {
  const double end = changing() ? plan_.end_rate : now.rate;
  const double base =
      changing() ? plan_.step[static_cast<std::size_t>(plan_.position)].curvature : 0.0;
  const double missing = target - end;
  // One cycle of γ and its undoing move the rate by at least γ cycle².
  double strongest = base + missing / (cycle_ * cycle_);
  if (!strongest_push(now, strongest, lookahead, strongest)) return;

  const double most = strongest - base;
  if (most * missing <= 0.0) return;

  const double toward = std::copysign(1.0, missing);
  PushSearch search(memory_, toward * missing);
  int left = kStretchesACycle;
  while (left > 0 && search.goes_on()) {
    const Outcome outcome = prove(now, base + search.share() * most, lookahead, left);
    const double gain = toward * (trial_.end_rate - end);
    if (outcome == Outcome::kNone) {
      search.refuse();
    } else if (outcome == Outcome::kTooFar || gain > toward * missing + kSameRate) {
      search.go_too_far(gain);
    } else {
      std::swap(plan_, trial_);
      search.accept(gain);
    }
  }
  memory_ = search.memory();
}

bool RateGovernor::strongest_push(const RateState& now, double wanted, const Lookahead& lookahead,
                                  double& push) noexcept VIAPOINT_NONBLOCKING {
  // The push itself may raise the rate within the cycle.
  const double raised = std::max(0.0, now.slope) + (wanted > 0.0 ? 0.5 * max_slope_ : 0.0);
  const double furthest = now.tau + cycle_ * std::min(1.0, now.rate + cycle_ * raised);
  if (!lookahead.ranges(now.tau, furthest, stretch_.path)) return false;
  stretch_.begin(now.rate, now.slope, cycle_);
  const double low = std::max(-max_curvature_, (-max_slope_ - now.slope) / cycle_);
  const double high = std::min(max_curvature_, (max_slope_ - now.slope) / cycle_);
  push = 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    stretch_.rate = within_unit(hull(now.rate, now.after(cycle_, push).rate));
    push = std::clamp(wanted, low, high);
    if (!limits_.strongest(stretch_, push)) return false;
  }
  return true;
}

RateGovernor::Outcome RateGovernor::prove(RateState state, double push, const Lookahead& lookahead,
                                          int& left) noexcept VIAPOINT_NONBLOCKING {
  trial_.steps = 0;
  trial_.position = 0;
  --left;
  RateState next = state.after(cycle_, push);
  const Range rates = rates_between(state, next, push);
  bool is_outside = leaves_unit(rates);
  next.tau = std::max(next.tau, state.tau);
  stretch_.begin(state.rate, state.slope, cycle_);
  stretch_.rate = within_unit(rates);
  stretch_.slope = hull(state.slope, next.slope);
  stretch_.curvature = push;
  if (!lookahead.ranges(state.tau, next.tau, stretch_.path) || !limits_.kept(stretch_)) {
    return Outcome::kNone;
  }
  if (std::abs(next.slope) < kSameRate) next.slope = 0.0;
  trial_.step[static_cast<std::size_t>(trial_.steps++)] = {push, 1};
  state = next;
  while (state.slope != 0.0) {
    if (trial_.steps > kSteps || --left < 0 || !step_back(state, lookahead)) {
      return Outcome::kNone;
    }
    if (leaves_unit({state.rate, state.rate})) is_outside = true;
    if (leaves_unit({state.rate + kFarOutside, state.rate - kFarOutside})) return Outcome::kNone;
  }
  trial_.end_rate = is_outside ? state.rate : std::clamp(state.rate, 0.0, 1.0);
  return is_outside ? Outcome::kTooFar : Outcome::kProven;
}

bool RateGovernor::step_back(RateState& state,
                             const Lookahead& lookahead) noexcept VIAPOINT_NONBLOCKING {
  // Until slope 0 and never past it, so that the rate stays between those here.
  int cycles = longest_step(trial_.steps - 1);
  const double time = cycles * cycle_;
  const double rate = std::clamp(state.rate, 0.0, 1.0);
  const double furthest = state.tau + time * (rate + 0.5 * time * std::max(0.0, state.slope));
  if (!lookahead.ranges(state.tau, furthest, stretch_.path)) return false;
  stretch_.begin(rate, state.slope, time);
  stretch_.rate = within_unit(hull(state.rate, state.rate + time * state.slope));
  const double undone = -state.slope / cycle_;
  double gamma = std::clamp(undone, -max_curvature_, max_curvature_);
  if (!limits_.strongest(stretch_, gamma)) return false;
  const double found = gamma;
  if (gamma * undone > 0.0 && std::abs(undone) <= cycles * std::abs(gamma)) {
    cycles = static_cast<int>(std::ceil(undone / gamma));
    gamma = undone / cycles;
  }
  RateState next = state.after(cycles * cycle_, gamma);
  if (gamma * undone > 0.0 && std::abs(next.slope) <= kSameRate) next.slope = 0.0;
  next.tau = std::max(next.tau, state.tau);
  const bool is_away = gamma * undone < 0.0;  // from slope 0: a joint has forced it
  if (is_away && (next.tau > furthest || std::abs(next.slope) > max_slope_)) return false;
  // Where a joint forces a curvature, less than what was found may be too little.
  if (is_away || gamma != found) {
    stretch_.time = cycles * cycle_;
    stretch_.rate = within_unit(rates_between(state, next, gamma));
    stretch_.slope = hull(state.slope, next.slope);
    stretch_.curvature = gamma;
    if (!limits_.kept(stretch_)) return false;
  }
  trial_.step[static_cast<std::size_t>(trial_.steps++)] = {gamma, cycles};
  state = next;
  return true;
}

}  // namespace viapoint
