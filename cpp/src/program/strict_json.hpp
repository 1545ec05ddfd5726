/// @file
/// JSON text to a value, without the freedoms of the format that would hide a mistake.
#pragma once

#include <string>

#include "program/json_reader.hpp"

namespace viapoint::program_json {

/// How deep values may stand in one another. A program needs nine levels; without a bound, a file
/// of nothing but brackets would overflow the stack of whatever walks through it later.
inline constexpr int kDeepest = 64;

/// Parses `text`. A member that is there twice is refused: of two values one would be ignored.
/// @param source file that the text is from, for messages
/// @throws MotionError(kBadProgram) naming the file and the place
[[nodiscard]] Json parse_strictly(const std::string& text, const std::string& source);

}  // namespace viapoint::program_json
