/// @file
/// Timing of a stretch of one path piece, and the proof that it keeps the limits.
#pragma once

#include <array>
#include <vector>

#include "trajectory/path_timing_course.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::path_timing {

/// The path parameter and its time derivatives at one instant: s, ṡ, s̈.
struct RateState {
  double s = 0.0, rate = 0.0, change = 0.0;
};

/// u(x), a quintic in x = t / duration, on one path piece.
struct TimedSpan {
  size_t piece = 0;           ///< of the path, and stretch of the course
  double duration = 0.0;      ///< [s]
  std::array<double, 6> u{};  ///< coefficient of x^k

  /// From one state to another (s counted from the start of the piece, which is `length` long), C²
  /// in time: quintic Hermite interpolation.
  [[nodiscard]] static TimedSpan between(size_t piece, double length, const RateState& from,
                                         const RateState& to, double duration);
  /// Constant jerk from `from`; `end` is the s that is reached, so that rounding leaves no gap.
  [[nodiscard]] static TimedSpan constant_jerk(size_t piece, double length, const RateState& from,
                                               double jerk, double end, double duration);
};

/// What a bound on a span rests on: never below what is reached, never above what is proven.
struct ShareBounds {
  Shares reached;  ///< found at a sample
  Shares proven;   ///< nowhere exceeded
};

/// Bounds of one span, by samples and what may lie between them (rate_bounds.hpp).
/// @param cells number of parts that the span is cut into, a power of two
/// @param slack how far apart the two may be on a straight stretch, relative
[[nodiscard]] ShareBounds bound_shares(const Course& course, const TimedSpan& span, int cells,
                                       double slack);

/// Bounds of all spans, as tight as `slack` (relative to the worst that is reached anywhere).
[[nodiscard]] Shares prove(const Course& course, const std::vector<TimedSpan>& spans, double slack);

/// True if all numbers are finite, u stays in [0, 1] and never goes back, to rounding.
[[nodiscard]] bool goes_forward(const TimedSpan& span);

/// Multiplies all durations.
void stretch_time(std::vector<TimedSpan>& spans, double factor);

[[nodiscard]] double total_duration(const std::vector<TimedSpan>& spans);

[[nodiscard]] std::vector<TrajectoryPiece> to_pieces(const JointPath& path,
                                                     const std::vector<TimedSpan>& spans);

}  // namespace viapoint::path_timing
