/// @file
/// Timing by bounds that hold along the whole section: never the quickest, always there.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "trajectory/path_timing_span.hpp"

namespace viapoint::path_timing {

/// Ceilings on ṡ, |s̈| and |s⃛| along a whole section.
struct UniformCeilings {
  double rate = 0.0, change = 0.0, jerk = 0.0;
};

/// Ceilings that keep every limit wherever the section is and whatever ṡ, s̈, s⃛ are within them,
/// from bounds of |q'|, |q''|, |q'''| and of the tool's rates.
/// @param tool one a piece of the path, or none
/// @throws MotionError(kZeroLength) if no joint moves
[[nodiscard]] UniformCeilings uniform_ceilings(const JointPath& path, const JointLimits& limits,
                                               std::span<const ToolRates> tool);

/// Ceilings of a section along which q' is constant and all pieces share their limits; nothing for
/// any other. Under these the seven-phase move is the quickest there is.
[[nodiscard]] std::optional<UniformCeilings> straight_ceilings(const JointPath& path,
                                                               const JointLimits& limits);

/// The rest-to-rest seven-phase move under the ceilings, cut where path pieces meet.
[[nodiscard]] std::vector<TimedSpan> seven_phases(const JointPath& path,
                                                  const UniformCeilings& ceilings);

}  // namespace viapoint::path_timing
