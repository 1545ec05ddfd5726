#include "viapoint/realtime/rate_governor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viapoint {
namespace {

/// Rates that differ by less are the same: a step of this size is far below every limit's slack.
constexpr double kSameRate = 1e-12;
/// Largest change of the rate in a cycle, and cycles to get there, where the joints would allow
/// more (at rest they allow anything).
constexpr double kMaxRateStep = 0.5;
constexpr double kCyclesToMaxSlope = 1.0;
/// Outside of [0, 1] by more than this, the end of a way back says nothing any more.
constexpr double kFarOutside = 0.5;
/// Pushes tried a cycle, and how much of one that has no way back is tried next.
constexpr int kTrials = 3;
constexpr double kShrink = 0.6;
/// Least share of the strongest push that is tried.
constexpr double kLeastShare = 1.0 / 64.0;

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
  gain_ = 0.0;
  share_ = 1.0;
}

double RateGovernor::decide(const RateState& now, double target,
                            const Lookahead& lookahead) noexcept VIAPOINT_NONBLOCKING {
  wanted_ = target;
  const double end = changing() ? plan_.end_rate : now.rate;
  if (std::abs(target - end) > kSameRate) improve(now, target, lookahead);
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

  // As strong as was possible last time; less, where as much as last time would go too far.
  double push = base + share_ * (strongest - base);
  const double gain = std::exchange(gain_, 0.0);
  if (gain * missing > 0.0 && std::abs(gain) > std::abs(missing)) {
    push = base + missing / gain * (strongest - base);
  }
  int budget = kStepsACycle;
  for (int trial = 0; trial < kTrials && (push - base) * missing > 0.0; ++trial) {
    const Outcome outcome = prove(now, push, lookahead, trial_, budget);
    const double gained = trial_.end_rate - end;
    const double over = (gained - missing) * (missing > 0.0 ? 1.0 : -1.0);
    if (outcome == Outcome::kProven && over <= kSameRate) {
      std::swap(plan_, trial_);
      gain_ = gained;
      share_ = std::min(1.0, 2.0 * share_);
      return;
    }
    if (outcome == Outcome::kNone) {
      push = base + kShrink * (push - base);
      share_ = std::max(kLeastShare, kShrink * share_);
    } else {
      // The end is convex in the push, so the chord stays on the near side.
      push = base + (push - base) * missing / gained;
    }
  }
}

bool RateGovernor::strongest_push(const RateState& now, double wanted, const Lookahead& lookahead,
                                  double& push) const noexcept VIAPOINT_NONBLOCKING {
  RateStretch stretch;
  const double furthest = now.tau + cycle_ * (now.rate + cycle_ * max_slope_);
  if (!lookahead.ranges(now.tau, furthest, stretch.path)) return false;
  stretch.slope = {now.slope, now.slope};
  const double low = std::max(-max_curvature_, (-max_slope_ - now.slope) / cycle_);
  const double high = std::min(max_curvature_, (max_slope_ - now.slope) / cycle_);
  push = 0.0;
  // Again, because the push itself raises the rate within the cycle.
  for (int pass = 0; pass < 2; ++pass) {
    stretch.rate = within_unit(hull(now.rate, now.after(cycle_, push).rate));
    push = std::clamp(wanted, low, high);
    if (!limits_.strongest(stretch, cycle_, push)) return false;
  }
  return true;
}

RateGovernor::Outcome RateGovernor::prove(RateState state, double push, const Lookahead& lookahead,
                                          Plan& plan,
                                          int& budget) const noexcept VIAPOINT_NONBLOCKING {
  plan.steps = 0;
  plan.position = 0;
  RateState next = state.after(cycle_, push);
  RateStretch stretch;
  const Range rates = rates_between(state, next, push);
  bool is_outside = leaves_unit(rates);
  stretch.rate = within_unit(rates);
  stretch.slope = hull(state.slope, next.slope);
  stretch.curvature = push;
  next.tau = std::max(next.tau, state.tau);
  if (!lookahead.ranges(state.tau, next.tau, stretch.path) || !limits_.kept(stretch)) {
    return Outcome::kNone;
  }
  if (std::abs(next.slope) < kSameRate) next.slope = 0.0;
  plan.step[static_cast<std::size_t>(plan.steps++)] = {push, 1};
  state = next;
  while (state.slope != 0.0) {
    if (plan.steps > kSteps || --budget < 0 || !step_back(state, lookahead, plan)) {
      return Outcome::kNone;
    }
    if (leaves_unit({state.rate, state.rate})) is_outside = true;
    if (leaves_unit({state.rate + kFarOutside, state.rate - kFarOutside})) return Outcome::kNone;
  }
  plan.end_rate = is_outside ? state.rate : std::clamp(state.rate, 0.0, 1.0);
  return is_outside ? Outcome::kTooFar : Outcome::kProven;
}

bool RateGovernor::step_back(RateState& state, const Lookahead& lookahead,
                             Plan& plan) const noexcept VIAPOINT_NONBLOCKING {
  // Until slope 0 and never past it, so that the rate stays between those here.
  int cycles = longest_step(plan.steps - 1);
  const double time = cycles * cycle_;
  const double furthest = state.tau + time * (std::clamp(state.rate, 0.0, 1.0) +
                                              0.5 * time * std::max(0.0, state.slope));
  RateStretch stretch;
  if (!lookahead.ranges(state.tau, furthest, stretch.path)) return false;
  stretch.rate = within_unit(hull(state.rate, state.rate + time * state.slope));
  stretch.slope = {state.slope, state.slope};
  const double undone = -state.slope / cycle_;
  double gamma = std::clamp(undone, -max_curvature_, max_curvature_);
  if (!limits_.strongest(stretch, time, gamma)) return false;
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
    stretch.rate = within_unit(rates_between(state, next, gamma));
    stretch.slope = hull(state.slope, next.slope);
    stretch.curvature = gamma;
    if (!limits_.kept(stretch)) return false;
  }
  plan.step[static_cast<std::size_t>(plan.steps++)] = {gamma, cycles};
  state = next;
  return true;
}

}  // namespace viapoint
