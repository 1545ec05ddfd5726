/// @file
/// One axis' way from state to state within all its limits, those of the position included.
#pragma once

#include "profile/axis_problem.hpp"
#include "profile/walled_route.hpp"

namespace viapoint {

/// As AxisProblem, which does the work where there are no position limits or none is met.
/// Real-time: safe.
class MoveProblem {
 public:
  // NOLINTNEXTLINE(modernize-use-equals-default): that would have it filled with zeros first
  MoveProblem() noexcept {}

  /// Solves for the quickest motion; what comes back inside the limits of velocity and acceleration
  /// is appended to `move`, which starts at `start`.
  [[nodiscard]] MoveStatus solve(const AxisState& start, const AxisState& end,
                                 const AxisLimits& limits, AxisMove& move) noexcept;
  /// Of the quickest, counted from the start [s]. The rest: @pre solve() returned kSolved
  [[nodiscard]] double duration() const noexcept { return duration_; }
  /// `move` is the one solve() has begun. Both return false, with `move` unfit for use, where the
  /// way between the walls has more phases than a move holds.
  [[nodiscard]] bool append_quickest(AxisMove& move) const noexcept;
  /// A duration not under `duration` that some motion has, counted from the start: the shortest
  /// where no position limit comes in the way.
  /// @pre `duration` not under that of the quickest
  [[nodiscard]] double next_duration(double duration, const AxisMove& begun) noexcept;
  /// A motion that lasts `duration`. @pre next_duration returned it
  [[nodiscard]] bool append_lasting(double duration, AxisMove& move) noexcept;

 private:
  [[nodiscard]] MoveStatus solve_between_walls(const AxisState& start, const AxisLimits& limits,
                                               const AxisMove& begun) noexcept;
  /// Whether one of the ways to spend `duration` stays between the walls; then `move` is it.
  [[nodiscard]] bool find_lasting(double duration, AxisMove& move) noexcept;
  [[nodiscard]] bool find_stretched(double more, AxisMove& move) const noexcept;
  [[nodiscard]] const Route& calm() noexcept;
  /// Appends the legs, one of them longer by `more`, or a rest of that length.
  [[nodiscard]] bool append_route(const Route& route, int stretched, double more,
                                  AxisMove& move) const noexcept;

  /// What is needed between walls.
  struct Between {
    AxisLimits limits;   ///< of velocity and acceleration only
    AxisState from, to;  ///< after the way back inside those
    double begun;        ///< duration of that way
    Walls walls;
    Route route, calm;
    bool has_calm;
    int searches;
  };

  /// Made only where there are walls.
  union MaybeBetween {
    MaybeBetween() noexcept {}
    Between value;
  };

  AxisProblem free_;
  double duration_;
  bool has_walls_;
  MaybeBetween between_;
};

}  // namespace viapoint
