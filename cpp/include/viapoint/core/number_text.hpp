/// @file
#pragma once

#include <string>

namespace viapoint {

/// The shortest decimal text that reads back to the same double, for messages that hold a value
/// against its limit: two numbers that differ never look alike. "inf", "-inf" and "nan" for what
/// is not finite. Real-time: not. Threads: any.
[[nodiscard]] std::string number_text(double value);
/// The same to nine places after the point, without the digits that rounding made, for values whose
/// limits are further away than that. Real-time: not. Threads: any.
[[nodiscard]] std::string rounded_text(double value);
/// Three digits of a value above zero, rounded down so that what was found to fit still does; "0"
/// for any other. Real-time: not. Threads: any.
[[nodiscard]] std::string rounded_down_text(double value);

}  // namespace viapoint
