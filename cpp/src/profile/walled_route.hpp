/// @file
/// The way of one axis between walls: legs from touch to touch, each the quickest there is.
///
/// A limit on the position is one on the third integral of the jerk, so that a quickest motion
/// meets it in isolated moments only, with the velocity zero and the acceleration pointing inside
/// (Bryson, Denham & Dreyfus 1963 for state constraints of higher order). Split there, it falls
/// into motions without walls, each the quickest between its ends, and what is left to find is one
/// acceleration a touch: the one with the least sum of durations.
#pragma once

#include <array>

#include "profile/position_walls.hpp"
#include "viapoint/profile/axis_move.hpp"

namespace viapoint {

/// Legs between the states in between. Not initialised: many wait in arrays for few that are used.
struct Route {
  static constexpr int kMostStops = 10;
  std::array<AxisState, kMostStops> stop;
  int stops;
  int rest;         ///< the first stop at rest, where the axis could wait; −1 where there is none
  double duration;  ///< of all legs; infinite where there is no such way
};

/// Ways from `from` to `to`, both within the limits of velocity and acceleration. Real-time: safe.
class RouteSearch {
 public:
  RouteSearch(const AxisState& from, const AxisState& to, const AxisLimits& limits,
              const Walls& walls) noexcept
      : from_(from), to_(to), limits_(limits), walls_(walls) {}

  /// Why there can be no way at all; kSolved where there may be one. Where rounding alone puts a
  /// start or an end beyond what can be braked for, moves the walls by as much.
  [[nodiscard]] MoveStatus admit() noexcept { return admit(walls_, from_, to_); }
  [[nodiscard]] const Walls& walls() const noexcept { return walls_; }
  /// The quickest that touches the walls once or twice and takes less than `budget`.
  [[nodiscard]] Route quickest(double budget) const noexcept;
  /// One that comes to rest where it first can, and starts anew.
  [[nodiscard]] Route calm() const noexcept;

 private:
  struct Touches {
    std::array<AxisState, 2> at;
    int count;  ///< 0 where there is no such way
    double duration;
  };
  /// The quickest motion without walls.
  struct Leg {
    double duration;
    bool holds;  ///< stays between the walls
  };

  [[nodiscard]] MoveStatus admit(Walls& walls, const AxisState& from,
                                 const AxisState& to) const noexcept;
  [[nodiscard]] MoveStatus admit_high(Walls& walls, const AxisState& from, const AxisState& to,
                                      const AxisLimits& limits) const noexcept;
  [[nodiscard]] Leg leg(const AxisState& from, const AxisState& to) const noexcept;
  [[nodiscard]] Touches search(const AxisState& from, const AxisState& to, int most, double budget,
                               bool nested) const noexcept;
  /// @param bound lowered to what a way with another touch takes at least
  [[nodiscard]] Touches through(const AxisState& from, const AxisState& touch, const AxisState& to,
                                int most, double budget, double& bound) const noexcept;
  [[nodiscard]] static int come_to_rest(AxisState from, const AxisLimits& limits,
                                        const Walls& walls, AxisState* stop) noexcept;

  AxisState from_, to_;
  AxisLimits limits_;
  Walls walls_;
};

}  // namespace viapoint
