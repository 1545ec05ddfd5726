/// @file
/// Arcs, turns and splines as JSON.
#pragma once

#include "program/json_reader.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::program_json {

/// Adds the members of the move to its step.
void write(Json& step, const CircMove& move);
void write(Json& step, const TurnMove& move);
void write(Json& step, const SplineMove& move);

/// @param step the whole step
[[nodiscard]] CircMove circ_of(const Node& step);
[[nodiscard]] TurnMove turn_of(const Node& step);
[[nodiscard]] SplineMove spline_of(const Node& step);

}  // namespace viapoint::program_json
