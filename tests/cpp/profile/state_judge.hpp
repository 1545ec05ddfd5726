/// @file
/// What must hold of a motion from state to state, worked out anew from its phases in long double
/// and with nothing of the solver's code.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "profile/state_problems.hpp"

namespace viapoint::testing {

/// Shares of the size of a motion, or of a limit. The worst of many is found by `take`.
struct StateFaults {
  double position = 0.0, velocity = 0.0, acceleration = 0.0;  ///< phases and end that do not meet
  double velocity_limit = 0.0, acceleration_limit = 0.0, jerk_limit = 0.0;  ///< over a limit
  double line = 0.0;      ///< beside the straight line
  double sampled = 0.0;   ///< between AxisMove::at and the phases
  double duration = 0.0;  ///< between the phases' sum, the total and what was asked for
  bool finite = true;

  void take(const StateFaults& other) {
    position = std::max(position, other.position);
    velocity = std::max(velocity, other.velocity);
    acceleration = std::max(acceleration, other.acceleration);
    velocity_limit = std::max(velocity_limit, other.velocity_limit);
    acceleration_limit = std::max(acceleration_limit, other.acceleration_limit);
    jerk_limit = std::max(jerk_limit, other.jerk_limit);
    line = std::max(line, other.line);
    sampled = std::max(sampled, other.sampled);
    duration = std::max(duration, other.duration);
    finite = finite && other.finite;
  }
  /// What is beyond `meets` of the size or `holds` of a limit, in words; empty where nothing is.
  [[nodiscard]] std::string beyond(double meets, double holds) const {
    std::string text;
    const auto add = [&](const char* name, double value, double allowed) {
      if (!(value <= allowed))
        text += std::string(name) + " " + std::to_string(value / allowed) + " x ";
    };
    if (!finite) text += "not finite ";
    add("position", position, meets);
    add("velocity", velocity, meets);
    add("acceleration", acceleration, meets);
    add("velocity limit", velocity_limit, holds);
    add("acceleration limit", acceleration_limit, holds);
    add("jerk limit", jerk_limit, holds);
    add("line", line, meets);
    add("sampled", sampled, meets);
    add("duration", duration, holds);
    return text;
  }
};

/// A cubic, from its state at t = 0.
struct Cubic {
  long double q, qd, qdd, qddd;

  explicit Cubic(const AxisState& s) : q(s.q), qd(s.qd), qdd(s.qdd), qddd(s.qddd) {}
  [[nodiscard]] Cubic after(long double t) const {
    Cubic c = *this;
    c.q = q + t * (qd + t * (qdd / 2 + t * qddd / 6));
    c.qd = qd + t * (qdd + t * qddd / 2);
    c.qdd = qdd + t * qddd;
    return c;
  }
};

/// By which share of its limit a value is beyond it.
inline double excess(long double value, double low, double high) {
  return static_cast<double>(std::max((value - high) / high, (value - low) / low));
}

/// Judges one joint. A start outside the limits is let in first: limits count from the first phase
/// that begins inside.
inline StateFaults judge(const AxisState& start, const AxisState& end, const AxisLimits& l,
                         const AxisMove& move) {
  StateFaults faults;
  if (!std::isfinite(move.total) || move.phases < 0 || move.phases > AxisMove::kMaxPhases) {
    faults.finite = false;
    return faults;
  }
  // Positions count in how far the motion gets from its start, rates in what they may be. A
  // position far from zero has its own rounding, which counts as size.
  long double size = std::abs(end.q - start.q) + 1e-6L * std::abs(start.q);
  const long double speed = std::max({l.velocity_max, -l.velocity_min, std::abs(start.qd)});
  const long double push = std::max({l.acceleration_max, -l.acceleration_min, std::abs(start.qdd)});
  long double time = 0.0L;
  for (int i = 0; i < move.phases; ++i) {
    const auto& [seconds, from] = move.phase[static_cast<std::size_t>(i)];
    faults.finite = faults.finite && seconds > 0.0 && std::isfinite(from.q) &&
                    std::isfinite(from.qd) && std::isfinite(from.qdd) && std::isfinite(from.qddd);
    time += seconds;
    const Cubic begin(from);
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Cubic c = begin.after(share * static_cast<long double>(seconds));
      size = std::max(size, std::abs(c.q - start.q));
    }
  }
  faults.duration =
      move.total > 0.0 ? static_cast<double>(std::abs(time - move.total) / move.total) : 0.0;

  // Time itself is rounded, late in a long motion by more than a short phase can hold; what rates
  // change in that time cannot be held against them.
  const long double clock_rounding = 1e-15L * time;
  const long double jerk = std::max(l.jerk_max, -l.jerk_min);
  Cubic before(start);
  const auto meet = [&](const Cubic& here, const Cubic& there) {
    const auto share = [](long double gap, long double allowed, long double of) {
      return static_cast<double>(std::max(0.0L, std::abs(gap) - allowed) / of);
    };
    if (size > 0.0L) faults.position += share(here.q - there.q, 0.0L, size);
    faults.velocity += share(here.qd - there.qd, clock_rounding * push, speed);
    faults.acceleration += share(here.qdd - there.qdd, clock_rounding * jerk, push);
  };
  bool inside = is_inside(start, l);
  double clock = 0.0;
  for (int i = 0; i < move.phases; ++i) {
    const auto& [seconds, from] = move.phase[static_cast<std::size_t>(i)];
    const Cubic begin(from), last = begin.after(seconds);
    meet(before, begin);
    faults.jerk_limit = std::max(faults.jerk_limit, excess(begin.qddd, l.jerk_min, l.jerk_max));
    inside = inside || is_inside(from, l);
    if (inside) {
      // The velocity is extreme where the acceleration vanishes, or at an end.
      const long double peak = begin.qddd != 0.0L ? std::clamp(-begin.qdd / begin.qddd, 0.0L,
                                                               static_cast<long double>(seconds))
                                                  : 0.0L;
      for (const Cubic& c : {begin, begin.after(peak), last}) {
        faults.velocity_limit =
            std::max(faults.velocity_limit, excess(c.qd, l.velocity_min, l.velocity_max));
        faults.acceleration_limit = std::max(faults.acceleration_limit,
                                             excess(c.qdd, l.acceleration_min, l.acceleration_max));
      }
    }
    const double t = clock + 0.5 * seconds;
    if (t > clock && t < clock + seconds) {
      const AxisState sampled = move.at(t);
      const Cubic wanted = begin.after(static_cast<long double>(t) - clock);
      faults.sampled = std::max(
          faults.sampled,
          static_cast<double>((std::abs(wanted.q - sampled.q) - clock_rounding * speed) / size));
    }
    clock += seconds;
    before = last;
  }
  meet(before, Cubic({end.q, end.qd, end.qdd, 0.0}));
  return faults;
}

/// Share of the motion's size by which its joints leave the straight line.
inline double beside_line(const StateProblem& problem, const StateToState& motion) {
  std::size_t leader = 0;
  const auto way = [&](std::size_t i) { return problem.end[i].q - problem.start[i].q; };
  for (std::size_t i = 0; i < problem.joints(); ++i) {
    if (std::abs(way(i)) > std::abs(way(leader))) leader = i;
  }
  double worst = 0.0;
  for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const JointState s = motion.at(share * motion.duration());
    const auto gone = [&](std::size_t i) {
      return s.q[static_cast<Eigen::Index>(i)] - problem.start[i].q;
    };
    const double size = std::max(std::abs(way(leader)), std::abs(gone(leader)));
    for (std::size_t i = 0; i < problem.joints(); ++i) {
      const double rounding = 1e-6 * std::abs(problem.start[i].q);
      const double gap = std::abs(gone(i) - gone(leader) * (way(i) / way(leader)));
      worst = std::max(worst, gap / (size + rounding));
    }
  }
  return worst;
}

/// Judges a whole motion, and that joints on a line stay on it.
inline StateFaults judge(const StateProblem& problem, const StateToState& motion) {
  StateFaults faults;
  const StateToStateOptions& options = problem.options;
  const bool together = options.synchronization != Synchronization::kNone;
  for (std::size_t i = 0; i < problem.joints(); ++i) {
    const AxisMove& move = motion.axis(static_cast<int>(i));
    faults.take(judge(problem.start[i], problem.end[i], problem.limits[i], move));
    const double T = motion.duration();
    if (together ? move.total != T : move.total > T) faults.duration = 1.0;
  }
  if (options.synchronization == Synchronization::kLine) faults.line = beside_line(problem, motion);
  if (motion.duration() < options.least_duration) faults.duration = 1.0;
  if (together && options.cycle > 0.0) {
    const double cycles = motion.duration() / options.cycle;
    faults.duration =
        std::max(faults.duration, std::abs(cycles - std::round(cycles)) / std::max(1.0, cycles));
  }
  return faults;
}

}  // namespace viapoint::testing
