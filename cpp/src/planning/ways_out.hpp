/// @file
/// What the program could do instead, tried before it is offered.
#pragma once

#include <string>
#include <vector>

#include "planning/leg_builder.hpp"

namespace viapoint::planning {

/// Moves to the same target from `start` that were found to work where the straight line `failed`
/// does not, each as a sentence.
[[nodiscard]] std::vector<std::string> ways_out_of(const LinMove& failed, const JointVector& start,
                                                   const LegBuilder& builder);

}  // namespace viapoint::planning
