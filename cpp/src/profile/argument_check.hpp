/// @file
/// Refusals that all laws share, so that they read alike.
#pragma once

#include <span>
#include <string>

#include "viapoint/core/error.hpp"

namespace viapoint {

/// A number as people write it, in up to 7 digits.
[[nodiscard]] std::string written(double value);

/// @throws MotionError(kBadArgument) with value and limit filled in
[[noreturn]] void refuse(const std::string& message, double value, double limit,
                         std::vector<std::string> ways_out = {});

/// @throws MotionError(kBadArgument) naming `what`
void require_finite(double value, const char* what);
void require_positive(double value, const char* what);
void require_finite(std::span<const double> values, const char* what);
void require_positive(std::span<const double> values, const char* what);
/// Sizes of points and of what belongs to each segment. @throws MotionError(kBadArgument)
void require_segments(size_t points, size_t segments, const char* what);

}  // namespace viapoint
