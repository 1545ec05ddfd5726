/// @file
/// The classic fixed-time form: lines through points at given times, joined by quartic transitions
/// of ±t_acc about the inner points (Paul 1981, ch. 5). Velocity and acceleration are continuous
/// inside; the motion starts and ends at speed.
#pragma once

#include <span>

#include "viapoint/profile/axis_law.hpp"

namespace viapoint {

/// Coefficients by τ = t + t_acc, τ in [0, 2 t_acc], of the transition past a point at the origin:
/// with h = τ/(2 t_acc) and K = to·t_acc/duration + from, it is K (2 − h) h³ − 2 from h + from.
/// @param from where the transition starts, seen from the point
/// @param to the next point, seen from this one, reached after `duration` [s]
/// Real-time: safe.
[[nodiscard]] Polynomial::Coefficients quartic_transition(double from, double to, double duration,
                                                          double t_acc);

/// Refuses what cannot be laid out: fewer than two points, durations that are not positive and
/// finite, a t_acc that does not fit (a segment with a transition at both ends must last 2 t_acc,
/// one with a transition at one end t_acc). The message names the segment and the largest t_acc.
/// @throws MotionError(kBadArgument)
void check_transitions(size_t points, std::span<const double> durations, double t_acc);

/// One axis through `points`, from time 0. @param points (k,); @param durations (k − 1,) [s]
/// @throws MotionError(kBadArgument), see check_transitions()
[[nodiscard]] AxisLaw quartic_transitions(std::span<const double> points,
                                          std::span<const double> durations, double t_acc);

}  // namespace viapoint
