/// @file
#pragma once

#include <array>
#include <cstdint>

namespace viapoint {

/// From which step on a run moves another tool. Motions are of the joints alone: this is kept for
/// whoever reads the run's log, and moves nothing.
struct ToolChange {
  std::int32_t move = 0;
  std::array<double, 16> tool{};  ///< pose_flange_tool, 4 by 4, row by row [m]
};

}  // namespace viapoint
