/// @file
/// Stretches whose tool speed is to be held: ṡ² = b is to equal C(σ) = v²/‖p'‖² there.
#pragma once

#include "trajectory/path_timing_grid.hpp"
#include "trajectory/path_timing_newton.hpp"
#include "trajectory/path_timing_span.hpp"
#include "viapoint/trajectory/tool_certificate.hpp"

namespace viapoint::path_timing {

/// The speed aimed at, as a share of the one asked for: half of what it may be held within lies on
/// either side.
inline constexpr double kHoldAim = 1.0 - 0.5 * kHeldWithin;

/// Where ceilings are pressed against and time cannot be stretched, all but that of the speed to be
/// held leave this much to what is between the nodes, and to the slack of the proof.
inline constexpr double kHeldRoom = 1.002;

[[nodiscard]] bool is_held(const Stretch& stretch);

/// True where the tool's speed has a limit, to be held or not.
[[nodiscard]] bool limits_speed(const Stretch& stretch);

/// The largest ṡ² that the limit of the tool's speed allows, with what it leaves where the speed is
/// not to be held, and its slope by σ. @pre limits_speed(stretch)
[[nodiscard]] NodeRate speed_ceiling(const Stretch& stretch, double sigma);

/// C and C' by σ. @pre is_held(stretch)
[[nodiscard]] NodeRate hold_rate(const Stretch& stretch, double sigma);

/// What the way between two places of a stretch takes at that speed [s].
[[nodiscard]] double hold_time(const Stretch& stretch, double from, double to);

/// At constant tool speed between two places of a stretch, exact at both and of the exact duration.
[[nodiscard]] TimedSpan hold_span(size_t piece, const Stretch& stretch, double from, double to);

/// True where hold_span() is proven to hold the speed.
[[nodiscard]] bool holds_speed(const Stretch& stretch, const TimedSpan& span);

/// The grid with cells halved until the speed can be held between their ends, and until the ceiling
/// of a speed that is only limited is as good as a cubic there.
[[nodiscard]] Grid refine_to_hold(const Course& course, Grid grid);

/// The largest that the speed is, over the one asked for: a bound over all stretches to be held.
[[nodiscard]] double largest_held_speed(const Course& course, const std::vector<TimedSpan>& spans);

}  // namespace viapoint::path_timing
