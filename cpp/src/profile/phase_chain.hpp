/// @file
/// The phases of an extreme motion, and what lies between two such motions of one duration.
#pragma once

#include <array>

#include "viapoint/profile/axis_move.hpp"

namespace viapoint {

/// Phases of one member of a family; accelerations at their starts are known without integration.
struct PhaseChain {
  struct Link {
    double duration, jerk, qdd;
    double qd;  ///< at its start; known from the second one to the cruise
  };
  std::array<Link, 7> links;
  int size = 0;
  double top = 0.0;  ///< velocity of a cruise
  int cruise = -1;   ///< its index

  /// None where `duration` is zero or, by rounding, less.
  void add(double jerk, double qdd, double duration) noexcept {
    if (duration > 0.0) links[static_cast<size_t>(size++)] = {duration, jerk, qdd, 0.0};
  }
  /// Works out the velocities before the cruise back from it: a start that is decades faster than
  /// the cruise rounds by more than the cruise's limit can bear.
  void measure_from_cruise() noexcept {
    double qd = top;
    for (int i = cruise - 1; i > 0; --i) {
      Link& link = links[static_cast<size_t>(i)];
      qd -= link.duration * (link.qdd + 0.5 * link.jerk * link.duration);
      link.qd = qd;
    }
  }
  /// Puts into `state` what is known at the start of a phase.
  void enter(int index, AxisState& state) const noexcept {
    const Link& link = links[static_cast<size_t>(index)];
    state.qdd = link.qdd;
    if (index == cruise || (cruise >= 0 && index == cruise + 1)) {
      state.qd = top;
    } else if (index > 0 && index < cruise) {
      state.qd = link.qd;
    }
  }
};

/// Adds the phases. What is known without integration takes the place of the integrated.
/// Real-time: safe.
void append(const PhaseChain& chain, AxisMove& move) noexcept;

/// Adds share · most + (1 − share) · least, state by state: two motions of one duration between
/// the same rates. What their durations differ by through rounding stays in the middle, where a
/// long motion has its long phases. Real-time: safe.
/// @param end of the motion; end.q is the position that the phases are made to meet
void append_blend(double share, const PhaseChain& most, const PhaseChain& least,
                  const AxisState& end, AxisMove& move) noexcept;

}  // namespace viapoint
