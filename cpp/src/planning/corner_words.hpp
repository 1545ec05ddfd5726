/// @file
/// What a program could say instead, where a zone came out smaller than asked for or as a stop.
#pragma once

#include <string>
#include <vector>

#include "viapoint/planning/motion_planner.hpp"

namespace viapoint::planning {

/// What would avoid the outcome, by its reason, the likeliest first; never empty where a zone was
/// shrunk or became a stop.
[[nodiscard]] std::vector<std::string> ways_out_of(const CornerOutcome& corner);

}  // namespace viapoint::planning
