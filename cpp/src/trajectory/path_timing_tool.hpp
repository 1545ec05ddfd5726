/// @file
/// The limits of the tool as the timing sees them: shares of a place, of a span, of a whole piece.
#pragma once

#include <array>

#include "trajectory/path_timing_course.hpp"
#include "trajectory/rate_bounds.hpp"

namespace viapoint::path_timing {

/// The acceleration of the tool point, or of its turning, as a share of its limit is the length of
/// (b · ṡ² + slope · s̈, normal · ṡ²): its parts along the direction of motion and across it.
struct ToolCone {
  double b = 0.0, slope = 0.0, normal = 0.0;

  [[nodiscard]] bool counts() const { return slope > 0.0 || b != 0.0 || normal > 0.0; }
};

/// What a place of a stretch asks of the tool, by its σ.
struct ToolPlace {
  double velocity = 0.0;          ///< share of the speed limits for σ̇ = 1
  std::array<ToolCone, 2> cones;  ///< of its point and of its turning
};

/// @pre stretch.tool != nullptr
[[nodiscard]] ToolPlace tool_at(const Stretch& stretch, double sigma);

/// Largest shares of the tool's limits at and between the samples.
struct ToolBounds {
  Shares reached, proven;
};
[[nodiscard]] ToolBounds tool_bounds(const ToolRates& tool, const TimingSamples& samples);

/// Bounds over a whole piece of what ṡ² and |s̈| are multiplied by in the tool's shares, by σ, and
/// of the share of speed for ṡ = 1.
struct ToolCeilings {
  double velocity = 0.0, acceleration1 = 0.0, acceleration2 = 0.0;
};
[[nodiscard]] ToolCeilings tool_ceilings(const ToolRates& tool, double length);

}  // namespace viapoint::path_timing
