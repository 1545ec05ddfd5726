/// @file
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace viapoint {

/// From which step on a run moves another tool. Motions are of the joints alone: this is kept for
/// whoever reads the run's log, and moves nothing.
struct ToolChange {
  std::int32_t move = 0;
  std::array<double, 16> tool{};  ///< pose_flange_tool, 4 by 4, row by row [m]
};

/// So many changes of a run are kept.
inline constexpr std::size_t kMaxTools = 100'000;

}  // namespace viapoint
