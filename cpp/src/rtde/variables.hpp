/// @file
/// The variables of RTDE by name: what clients can read, and what they can set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "rtde/arm_view.hpp"
#include "rtde/wire.hpp"

namespace viapoint::rtde {

/// What clients are told a variable's type is when there is none of its name.
inline constexpr std::string_view kNotFound = "NOT_FOUND";

/// True for the names of a family of 48 registers, as "input_int_register_23".
[[nodiscard]] bool is_register(std::string_view name, std::string_view family);

/// A variable that clients read.
struct OutputVariable {
  std::string_view name;
  std::string_view type;  ///< as it is called on the wire
  void (*write)(const ArmView& view, Bytes& bytes);
};

/// nullptr where there is none of this name.
[[nodiscard]] const OutputVariable* find_output(std::string_view name);

/// What clients have told in one package. Whatever was not in it switches nothing.
struct Told {
  std::uint32_t slider_mask = 0;  ///< not 0: the fraction counts
  double slider_fraction = std::numeric_limits<double>::quiet_NaN();
  // Bit i for output i: which are to be switched, which were told on or off, and what.
  std::uint64_t output_mask = 0, told_outputs = 0, outputs = 0;
};

/// A variable that clients set.
struct InputVariable {
  std::string_view name;
  std::string_view type;
  std::size_t bytes;
  /// Reads its bytes off the front.
  void (*read)(std::string_view& bytes, Told& told);
};

/// nullptr where there is none of this name.
[[nodiscard]] const InputVariable* find_input(std::string_view name);

}  // namespace viapoint::rtde
