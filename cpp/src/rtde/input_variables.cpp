#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

#include "rtde/variables.hpp"

namespace viapoint::rtde {
namespace {

constexpr int kRegisters = 48;

/// A group of outputs: where it begins in actual_digital_output_bits, and which bits it has.
struct Group {
  int first;
  std::uint64_t bits;
};
constexpr Group kStandard{0, 0xff}, kConfigurable{8, 0xff}, kTool{16, 0x03};

template <const Group& Outputs>
void read_output_mask(std::string_view& bytes, Told& told) {
  told.output_mask |= (take<std::uint8_t>(bytes) & Outputs.bits) << Outputs.first;
}

template <const Group& Outputs>
void read_outputs(std::string_view& bytes, Told& told) {
  told.told_outputs |= Outputs.bits << Outputs.first;
  told.outputs |= (take<std::uint8_t>(bytes) & Outputs.bits) << Outputs.first;
}

void read_slider_mask(std::string_view& bytes, Told& told) {
  told.slider_mask = take<std::uint32_t>(bytes);
}

void read_slider_fraction(std::string_view& bytes, Told& told) {
  told.slider_fraction = take<double>(bytes);
}

/// What this arm has not: clients may set it, and nothing comes of it.
template <typename T>
void read_nothing(std::string_view& bytes, Told& /*told*/) {
  (void)take<T>(bytes);
}
constexpr auto kNoByte = &read_nothing<std::uint8_t>;
constexpr auto kNoInt = &read_nothing<std::int32_t>;
constexpr auto kNoDouble = &read_nothing<double>;

constexpr std::array kInputs{
    InputVariable{"speed_slider_mask", "UINT32", 4, &read_slider_mask},
    InputVariable{"speed_slider_fraction", "DOUBLE", 8, &read_slider_fraction},
    InputVariable{"standard_digital_output_mask", "UINT8", 1, &read_output_mask<kStandard>},
    InputVariable{"standard_digital_output", "UINT8", 1, &read_outputs<kStandard>},
    InputVariable{"configurable_digital_output_mask", "UINT8", 1, &read_output_mask<kConfigurable>},
    InputVariable{"configurable_digital_output", "UINT8", 1, &read_outputs<kConfigurable>},
    InputVariable{"tool_digital_output_mask", "UINT8", 1, &read_output_mask<kTool>},
    InputVariable{"tool_digital_output", "UINT8", 1, &read_outputs<kTool>},
    InputVariable{"standard_analog_output_mask", "UINT8", 1, kNoByte},
    InputVariable{"standard_analog_output_type", "UINT8", 1, kNoByte},
    InputVariable{"standard_analog_output_0", "DOUBLE", 8, kNoDouble},
    InputVariable{"standard_analog_output_1", "DOUBLE", 8, kNoDouble},
};
constexpr InputVariable kIntRegister{"input_int_register_", "INT32", 4, kNoInt};
constexpr InputVariable kDoubleRegister{"input_double_register_", "DOUBLE", 8, kNoDouble};

}  // namespace

bool is_register(std::string_view name, std::string_view family) {
  if (!name.starts_with(family)) return false;
  const std::string_view digits = name.substr(family.size());
  int number = -1;
  const auto [end, error] = std::from_chars(digits.begin(), digits.end(), number);
  return error == std::errc{} && end == digits.end() && number >= 0 && number < kRegisters;
}

const InputVariable* find_input(std::string_view name) {
  const auto* const found =
      std::find_if(kInputs.begin(), kInputs.end(),
                   [name](const InputVariable& variable) { return variable.name == name; });
  if (found != kInputs.end()) return found;
  for (const InputVariable* family : {&kIntRegister, &kDoubleRegister}) {
    if (is_register(name, family->name)) return family;
  }
  return nullptr;
}

}  // namespace viapoint::rtde
