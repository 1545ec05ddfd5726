/// @file
/// What the program could do instead, tried before it is offered.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "planning/leg_builder.hpp"

namespace viapoint::planning {

/// Moves to the same goal from `start` that were found to work where a move on a tool curve does
/// not, each as a sentence.
/// @param goal where the move was to end
/// @param by_wrist the same move with the wrist joints interpolated; null where it was one already
[[nodiscard]] std::vector<std::string> ways_out_of(const Target& goal, const JointVector& start,
                                                   const LegBuilder& builder,
                                                   const std::function<Leg()>& by_wrist);

}  // namespace viapoint::planning
