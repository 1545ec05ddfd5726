#include "viapoint/profile/state_to_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "profile/move_problem.hpp"

namespace viapoint {
namespace {

/// Share of a state by which it may leave the line through rounding.
constexpr double kLineSlack = 1e-9;
/// Share of a position by which it may be beyond a limit, or off its place, through rounding.
constexpr double kPositionSlack = 1e-15;
/// Share of a cycle by which a duration may be over a whole number of them.
constexpr double kCycleSlack = 1e-9;
/// From here on a duration's last digit is more than a cycle.
constexpr double kMostCycles = 1e15;

/// A problem that is made only where there is an axis.
union Place {
  Place() noexcept {}
  MoveProblem problem;
};

/// The least duration both asked for and a whole number of cycles.
double rounded_up(double duration, const StateToStateOptions& options) noexcept {
  const double least = std::max(duration, options.least_duration);
  if (!(options.cycle > 0.0)) return least;
  const double cycles = least / options.cycle;
  if (!(cycles < kMostCycles)) return least;
  const double whole = std::round(cycles);
  if (cycles <= whole + kCycleSlack) return std::max(whole * options.cycle, least);
  return std::max(std::ceil(cycles) * options.cycle, least);
}

/// The least duration from `duration` on that is a whole number of cycles and that every axis has a
/// motion of. Infinite where there is none within as many rounds as there can be intervals.
/// @param begun what each problem's solve() has begun
/// @param culprit the last axis that had no motion of a duration
double common_duration(std::span<Place> problems, std::span<const AxisMove> begun, double duration,
                       const StateToStateOptions& options, size_t& culprit) noexcept {
  double common = rounded_up(duration, options);
  // Every axis has at most three intervals of durations it cannot have, and one more that is passed
  // over at position limits; the end of that one may lie in a gap between two cycles again.
  const size_t rounds = 8 * problems.size() + 1;
  for (size_t round = 0; round < rounds; ++round) {
    double next = common;
    for (size_t i = 0; i < problems.size(); ++i) {
      const double own = problems[i].problem.next_duration(next, begun[i]);
      if (own > next) culprit = i;
      next = std::max(next, own);
      if (!std::isfinite(next)) return next;
    }
    if (next == common) return common;
    common = rounded_up(next, options);
  }
  return std::numeric_limits<double>::infinity();
}

/// The motion of that duration, the quickest included, appended.
MoveStatus append_lasting(MoveProblem& problem, double duration, AxisMove& move) noexcept {
  if (!std::isfinite(duration)) return MoveStatus::kDurationImpossible;
  if (duration == problem.duration()) {
    return problem.append_quickest(move) ? MoveStatus::kSolved : MoveStatus::kNoRoom;
  }
  return problem.append_lasting(duration, move) ? MoveStatus::kSolved
                                                : MoveStatus::kDurationImpossible;
}

bool is_sound(const StateToStateOptions& options) noexcept {
  return std::isfinite(options.least_duration) && std::isfinite(options.cycle);
}

}  // namespace

MoveStatus StateToState::plan(std::span<const AxisState> start, std::span<const AxisState> end,
                              std::span<const AxisLimits> limits,
                              const StateToStateOptions& options) noexcept VIAPOINT_NONBLOCKING {
  joints_ = 0;
  culprit_ = -1;
  duration_ = 0.0;
  const size_t n = start.size();
  if (n < 1 || n > static_cast<size_t>(kMaxJoints) || end.size() != n || limits.size() != n) {
    return MoveStatus::kBadSize;
  }
  if (!is_sound(options)) return MoveStatus::kDurationImpossible;
  const MoveStatus status = options.synchronization == Synchronization::kLine
                                ? plan_line(start, end, limits, options)
                                : plan_apart(start, end, limits, options);
  if (status != MoveStatus::kSolved) {
    duration_ = 0.0;
    return status;
  }
  joints_ = static_cast<int>(n);
  return status;
}

MoveStatus StateToState::plan_apart(std::span<const AxisState> start,
                                    std::span<const AxisState> end,
                                    std::span<const AxisLimits> limits,
                                    const StateToStateOptions& options) noexcept {
  const size_t n = start.size();
  std::array<Place, kMaxJoints> problems;
  std::array<double, kMaxJoints> least{};
  for (size_t i = 0; i < n; ++i) {
    const MoveStatus status =
        std::construct_at(&problems[i].problem)->solve(start[i], end[i], limits[i], axes_[i]);
    if (status != MoveStatus::kSolved) {
      culprit_ = static_cast<int>(i);
      return status;
    }
    least[i] = problems[i].problem.duration();
  }
  const bool together = options.synchronization == Synchronization::kTime;
  if (together) {
    const double longest = *std::max_element(least.begin(), least.begin() + static_cast<long>(n));
    size_t culprit = 0;
    duration_ = common_duration({problems.data(), n}, axes_, longest, options, culprit);
    if (!std::isfinite(duration_)) {
      culprit_ = static_cast<int>(culprit);
      return MoveStatus::kDurationImpossible;
    }
  }
  for (size_t i = 0; i < n; ++i) {
    size_t alone = 0;
    const double own =
        together ? duration_
                 : common_duration({&problems[i], 1}, {&axes_[i], 1}, least[i], options, alone);
    const MoveStatus status = append_lasting(problems[i].problem, own, axes_[i]);
    if (status != MoveStatus::kSolved) {
      culprit_ = static_cast<int>(i);
      return status;
    }
    duration_ = std::max(duration_, own);
  }
  return MoveStatus::kSolved;
}

namespace {

/// s(t) along a unit of the line, from the joint that moves farthest.
struct Line {
  std::array<double, kMaxJoints> direction{};
  AxisState start, end;
  AxisLimits limits;
};

/// The multiple of `direction` that `values` is; NaN where it is none within rounding.
template <typename Read>
double multiple_of(const std::array<double, kMaxJoints>& direction,
                   std::span<const AxisState> states, Read read, size_t& culprit) noexcept {
  double product = 0.0, square = 0.0, largest = 0.0;
  for (size_t i = 0; i < states.size(); ++i) {
    product += direction[i] * read(states[i]);
    square += direction[i] * direction[i];
    largest = std::max(largest, std::abs(read(states[i])));
  }
  const double factor = product / square;
  for (size_t i = 0; i < states.size(); ++i) {
    if (!(std::abs(read(states[i]) - factor * direction[i]) <= kLineSlack * largest)) {
      culprit = i;
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
  return factor;
}

/// What two positions lose when one is taken from the other.
double position_rounding(const AxisState& start, const AxisState& end) noexcept {
  return kPositionSlack * (std::abs(start.q) + std::abs(end.q));
}

/// Least distance in which a state's velocity and acceleration can be brought to zero.
double stopping_way(const AxisState& s, const AxisLimits& l) noexcept {
  const double push = std::max(l.acceleration_max, -l.acceleration_min);
  const double jerk = std::max(l.jerk_max, -l.jerk_min);
  return 0.5 * s.qd * s.qd / push + std::abs(s.qdd * s.qdd * s.qdd) / (6.0 * jerk * jerk);
}

/// Whether any axis ends elsewhere than it starts by more than rounding, that of the positions and
/// that of the way it takes to turn what moves: 0.1 + 0.2 is no direction away from 0.3.
bool goes_somewhere(std::span<const AxisState> start, std::span<const AxisState> end,
                    std::span<const AxisLimits> limits) noexcept {
  double reach = 0.0;
  for (size_t i = 0; i < start.size(); ++i) {
    reach = std::max({reach, stopping_way(start[i], limits[i]), stopping_way(end[i], limits[i])});
  }
  for (size_t i = 0; i < start.size(); ++i) {
    const double none = position_rounding(start[i], end[i]) + kLineSlack * reach;
    if (!(std::abs(end[i].q - start[i].q) <= none)) return true;
  }
  return false;
}

/// Moves the end by what it is beside the line, in the velocity of the longest phase, where that is
/// rounding. Nothing moves where there are no phases: the end is then the start.
void bend(double beside, AxisMove& move) noexcept {
  if (move.phases == 0) {
    move.end.q -= beside;
    return;
  }
  const auto count = static_cast<size_t>(move.phases);
  size_t longest = 0;
  for (size_t k = 1; k < count; ++k) {
    if (move.phase[k].duration > move.phase[longest].duration) longest = k;
  }
  move.phase[longest].from.qd += beside / move.phase[longest].duration;
  for (size_t k = longest + 1; k < count; ++k) move.phase[k].from.q += beside;
}

/// Tightens `low <= factor <= high` by minimum <= factor · direction <= maximum.
void tighten(double direction, double minimum, double maximum, double& low, double& high) noexcept {
  const double a = minimum / direction, b = maximum / direction;
  low = std::max(low, std::min(a, b));
  high = std::min(high, std::max(a, b));
}

}  // namespace

MoveStatus StateToState::plan_line(std::span<const AxisState> start, std::span<const AxisState> end,
                                   std::span<const AxisLimits> limits,
                                   const StateToStateOptions& options) noexcept {
  const size_t n = start.size();
  Line line;
  double largest = 0.0;
  const auto take = [&](auto read) {
    if (largest > 0.0) return;
    for (size_t i = 0; i < n; ++i) {
      line.direction[i] = read(i);
      largest = std::max(largest, std::abs(line.direction[i]));
    }
  };
  const auto way = [&](size_t i) { return end[i].q - start[i].q; };
  if (goes_somewhere(start, end, limits)) take(way);
  take([&](size_t i) { return start[i].qd; });
  take([&](size_t i) { return end[i].qd; });
  take([&](size_t i) { return start[i].qdd; });
  take([&](size_t i) { return end[i].qdd; });
  take(way);  // from rest to rest it counts, however short
  if (!std::isfinite(largest)) return MoveStatus::kBadState;
  if (largest == 0.0) return plan_apart(start, end, limits, options);
  for (double& component : line.direction) component /= largest;

  size_t culprit = 0;
  const auto velocity = [](const AxisState& s) { return s.qd; };
  const auto acceleration = [](const AxisState& s) { return s.qdd; };
  line.start.qd = multiple_of(line.direction, start, velocity, culprit);
  line.start.qdd = multiple_of(line.direction, start, acceleration, culprit);
  line.end.qd = multiple_of(line.direction, end, velocity, culprit);
  line.end.qdd = multiple_of(line.direction, end, acceleration, culprit);
  size_t leader = 0;
  for (size_t i = 0; i < n; ++i) {
    if (std::abs(line.direction[i]) == 1.0) leader = i;
  }
  line.end.q = (end[leader].q - start[leader].q) / line.direction[leader];
  for (const double value : {line.start.qd, line.start.qdd, line.end.qd, line.end.qdd}) {
    if (!std::isnan(value)) continue;
    culprit_ = static_cast<int>(culprit);
    return MoveStatus::kNotParallel;
  }

  const double none = std::numeric_limits<double>::infinity();
  line.limits = {-none, none, -none, none, -none, none, -none, none};
  for (size_t i = 0; i < n; ++i) {
    const AxisLimits& l = limits[i];
    const double d = line.direction[i];
    if (!(l.position_min <= l.position_max)) {
      culprit_ = static_cast<int>(i);
      return MoveStatus::kBadLimits;
    }
    if (!(end[i].q >= l.position_min - kPositionSlack * std::abs(end[i].q) &&
          end[i].q <= l.position_max + kPositionSlack * std::abs(end[i].q))) {
      culprit_ = static_cast<int>(i);
      return MoveStatus::kEndPosition;
    }
    if (d == 0.0) continue;
    tighten(d, std::min(l.position_min - start[i].q, d * line.end.q),
            std::max(l.position_max - start[i].q, d * line.end.q), line.limits.position_min,
            line.limits.position_max);
    tighten(d, l.velocity_min, l.velocity_max, line.limits.velocity_min, line.limits.velocity_max);
    tighten(d, l.acceleration_min, l.acceleration_max, line.limits.acceleration_min,
            line.limits.acceleration_max);
    tighten(d, l.jerk_min, l.jerk_max, line.limits.jerk_min, line.limits.jerk_max);
  }

  AxisMove law;
  Place place;
  MoveProblem& problem = *std::construct_at(&place.problem);
  MoveStatus status = problem.solve(line.start, line.end, line.limits, law);
  if (status == MoveStatus::kSolved) {
    size_t alone = 0;
    duration_ = common_duration({&place, 1}, {&law, 1}, problem.duration(), options, alone);
    status = append_lasting(problem, duration_, law);
  }
  if (status != MoveStatus::kSolved) {
    culprit_ = static_cast<int>(leader);
    return status;
  }
  for (size_t i = 0; i < n; ++i) {
    const double d = line.direction[i];
    const auto scaled = [&](const AxisState& s) {
      return AxisState{start[i].q + d * s.q, d * s.qd, d * s.qdd, d * s.qddd};
    };
    AxisMove& move = axes_[i];
    move.phases = law.phases;
    move.total = law.total;
    for (size_t k = 0; k < static_cast<size_t>(law.phases); ++k) {
      move.phase[k] = {law.phase[k].duration, scaled(law.phase[k].from)};
    }
    move.end = {end[i].q, end[i].qd, end[i].qdd, 0.0};
    const double beside = end[i].q - (start[i].q + d * line.end.q);
    if (std::abs(beside) > position_rounding(start[i], end[i])) bend(beside, move);
  }
  return MoveStatus::kSolved;
}

JointState StateToState::at(double t) const noexcept VIAPOINT_NONBLOCKING {
  JointState state = JointState::zero(joints_);
  const double clamped = t < duration_ ? t : duration_;
  for (int i = 0; i < joints_; ++i) {
    const AxisMove& move = axis(i);
    const AxisState s =
        clamped > move.total ? move.after_end(clamped - move.total) : move.at(clamped);
    state.q[i] = s.q;
    state.qd[i] = s.qd;
    state.qdd[i] = s.qdd;
    state.qddd[i] = s.qddd;
  }
  return state;
}

}  // namespace viapoint
