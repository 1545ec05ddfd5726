/// @file
#pragma once

#include <vector>

#include "course.hpp"

namespace viapoint::laws {

/// The laws of one axis over time.
[[nodiscard]] std::vector<Subject<Course>> axis_courses();

}  // namespace viapoint::laws
