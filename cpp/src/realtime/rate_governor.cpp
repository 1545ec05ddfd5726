#include "viapoint/realtime/rate_governor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viapoint {
namespace {

/// Rates that differ by less are the same: a step of this size is far below every limit's slack.
constexpr double kSameRate = 1e-12;
/// A step of the way back that comes so near to slope 0 is one that lands there.
constexpr double kRounding = 1e-9;
/// Largest change of the rate in a cycle, and cycles to get there, where the joints would allow
/// more (at rest they allow anything).
constexpr double kMaxRateStep = 0.05;
constexpr double kCyclesToMaxSlope = 4.0;
/// A second, weaker step back for what the linear estimate of the room did not see.
constexpr double kWeaker = 0.9;
/// Pushes tried a cycle, and by how much each comes nearer to the proven one than the one before.
constexpr int kTrials = 5;
constexpr std::array<double, kTrials> kShrink = {0.8, 0.5, 0.5, 0.5, 0.0};

Range hull(double a, double b) noexcept { return {std::min(a, b), std::max(a, b)}; }

/// Takes ρ and α of `stretch` from a motion with γ = `gamma` that begins at `from`; false where ρ
/// would leave [0, 1].
bool take(RateStretch& stretch, const RateState& from, const RateState& to, double gamma) noexcept {
  Range rate = hull(from.rate, to.rate);
  if (from.slope * to.slope < 0.0) {
    const double turn = from.rate - 0.5 * from.slope * from.slope / gamma;
    rate.low = std::min(rate.low, turn);
    rate.high = std::max(rate.high, turn);
  }
  if (rate.low < -kSameRate || rate.high > 1.0 + kSameRate) return false;
  stretch.rate = {std::clamp(rate.low, 0.0, 1.0), std::clamp(rate.high, 0.0, 1.0)};
  stretch.slope = hull(from.slope, to.slope);
  stretch.curvature = gamma;
  return true;
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
  stride_ = static_cast<int>(
      std::clamp(std::ceil(kWayBack * longest / (kSteps * cycle)), 1.0, kMaxStride));
}

double RateGovernor::cell() const noexcept { return 0.5 * stride_ * cycle_; }

void RateGovernor::reset() noexcept VIAPOINT_NONBLOCKING {
  plan_.steps = 0;
  plan_.position = 0;
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

void RateGovernor::improve(const RateState& now, double target,
                           const Lookahead& lookahead) noexcept VIAPOINT_NONBLOCKING {
  const double end = changing() ? plan_.end_rate : now.rate;
  const double base =
      changing() ? plan_.step[static_cast<std::size_t>(plan_.position)].curvature : 0.0;
  const double missing = target - end;

  RateStretch stretch;
  const double furthest = now.tau + cycle_ * (now.rate + cycle_ * max_slope_);
  if (!lookahead.ranges(now.tau, furthest, stretch.path)) return;
  const Range allowed{std::max(-max_curvature_, (-max_slope_ - now.slope) / cycle_),
                      std::min(max_curvature_, (max_slope_ - now.slope) / cycle_)};
  // One cycle of γ and its undoing move the rate by at least γ cycle².
  const double wanted = base + missing / (cycle_ * cycle_);
  double push = 0.0;
  // Again, because the push itself raises the rate within the cycle.
  for (int pass = 0; pass < 2; ++pass) {
    Range curvature = allowed;
    stretch.slope = {now.slope, now.slope};
    stretch.rate = hull(now.rate, std::clamp(now.after(cycle_, push).rate, 0.0, 1.0));
    if (!limits_.room(stretch, cycle_, curvature)) return;
    push = std::clamp(wanted, curvature.low, curvature.high);
  }

  for (int trial = 0; trial < kTrials; ++trial) {
    if ((push - base) * missing <= 0.0) return;
    if (!prove(now, push, lookahead, trial_)) {
      push = base + kShrink[static_cast<std::size_t>(trial)] * (push - base);
      continue;
    }
    const double still_missing = target - trial_.end_rate;
    if (still_missing * missing >= 0.0 || std::abs(still_missing) <= kSameRate) {
      std::swap(plan_, trial_);
      return;
    }
    // Too far: the end is convex in the push, so the chord stays on the near side.
    push = base + (push - base) * missing / (missing - still_missing);
  }
}

bool RateGovernor::prove(RateState state, double push, const Lookahead& lookahead,
                         Plan& plan) const noexcept VIAPOINT_NONBLOCKING {
  plan.steps = 0;
  plan.position = 0;
  RateState next = state.after(cycle_, push);
  RateStretch stretch;
  if (next.tau < state.tau || !take(stretch, state, next, push)) return false;
  if (!lookahead.ranges(state.tau, next.tau, stretch.path) || !limits_.kept(stretch)) {
    return false;
  }
  if (std::abs(next.slope) < kSameRate) next.slope = 0.0;
  plan.step[static_cast<std::size_t>(plan.steps++)] = {push, 1};
  state = next;
  while (state.slope != 0.0) {
    if (plan.steps > kSteps || !step_back(state, lookahead, plan)) return false;
  }
  plan.end_rate = std::clamp(state.rate, 0.0, 1.0);
  return true;
}

bool RateGovernor::step_back(RateState& state, const Lookahead& lookahead,
                             Plan& plan) const noexcept VIAPOINT_NONBLOCKING {
  const double longest = stride_ * cycle_;
  RateStretch stretch;
  const double furthest =
      state.tau + longest * (state.rate + 0.5 * longest * std::max(0.0, state.slope));
  if (!lookahead.ranges(state.tau, furthest, stretch.path)) return false;

  // Straight back to slope 0 where that is allowed; never past it, nor away from it unless forced.
  const double wanted = -state.slope / cycle_;
  const auto strongest = [&](int cycles, double& gamma) {
    const double time = cycles * cycle_;
    stretch.slope = {state.slope, state.slope};
    stretch.rate = {state.rate, std::min(1.0, state.rate + time * std::max(0.0, state.slope))};
    Range curvature{-max_curvature_, max_curvature_};
    if (!limits_.room(stretch, time, curvature)) return false;
    gamma = std::clamp(wanted, curvature.low, curvature.high);
    return true;
  };
  double gamma = 0.0;
  if (!strongest(1, gamma)) return false;
  const int cycles = cycles_back(state.slope, gamma);
  if (cycles > 1 && !strongest(cycles, gamma)) return false;
  return try_step(state, gamma, furthest, stretch, plan) ||
         try_step(state, kWeaker * gamma, furthest, stretch, plan);
}

int RateGovernor::cycles_back(double slope, double gamma) const noexcept VIAPOINT_NONBLOCKING {
  if (gamma * slope > 0.0) return 1;
  const double cycles = gamma == 0.0 ? stride_ : -slope / (gamma * cycle_);
  return std::max(1, static_cast<int>(std::min(cycles, static_cast<double>(stride_))));
}

bool RateGovernor::try_step(RateState& state, double gamma, double furthest, RateStretch& stretch,
                            Plan& plan) const noexcept VIAPOINT_NONBLOCKING {
  const int cycles = cycles_back(state.slope, gamma);
  const double undone = -state.slope / cycle_;
  const bool lands = cycles == 1 && gamma * undone > 0.0 &&
                     std::abs(gamma) >= std::abs(undone) * (1.0 - kRounding);
  if (lands) gamma = undone;
  RateState next = state.after(cycles * cycle_, gamma);
  if (lands) next.slope = 0.0;
  const bool possible = take(stretch, state, next, gamma);
  if (!possible || next.tau > furthest || std::abs(next.slope) > max_slope_) return false;
  if (!limits_.kept(stretch)) return false;
  plan.step[static_cast<std::size_t>(plan.steps++)] = {gamma, cycles};
  state = next;
  return true;
}

}  // namespace viapoint
