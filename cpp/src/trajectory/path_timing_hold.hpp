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

/// Where ceilings are pressed against, those of the joints leave this much to what is between the
/// nodes.
inline constexpr double kHeldRoom = 1.002;

[[nodiscard]] bool is_held(const Stretch& stretch);

/// C and C' by σ. @pre is_held(stretch)
[[nodiscard]] NodeRate hold_rate(const Stretch& stretch, double sigma);

/// What the way between two places of a stretch takes at that speed [s].
[[nodiscard]] double hold_time(const Stretch& stretch, double from, double to);

/// At constant tool speed between two places of a stretch, exact at both and of the exact duration.
[[nodiscard]] TimedSpan hold_span(size_t piece, const Stretch& stretch, double from, double to);

/// True where hold_span() is proven to hold the speed.
[[nodiscard]] bool holds_speed(const Stretch& stretch, const TimedSpan& span);

/// The grid with cells halved until the speed can be held between their ends.
[[nodiscard]] Grid refine_to_hold(const Course& course, Grid grid);

/// The largest that the speed is, over the one asked for: a bound over all stretches to be held.
[[nodiscard]] double largest_held_speed(const Course& course, const std::vector<TimedSpan>& spans);

}  // namespace viapoint::path_timing
