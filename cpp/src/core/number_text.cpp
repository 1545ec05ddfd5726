#include "viapoint/core/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace viapoint {

std::string number_text(double value) {
  std::array<char, 32> digits{};  // 24 are needed at most
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

std::string rounded_text(double value) {
  constexpr double kPlaces = 1e9;
  constexpr double kWhole = 1e6;  // beyond, a double has no such places to round to
  return number_text(std::abs(value) < kWhole ? std::round(value * kPlaces) / kPlaces : value);
}

std::string rounded_down_text(double value) {
  if (!(value > 0.0)) return "0";
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", std::floor(value / unit) * unit);
  return text.data();
}

}  // namespace viapoint
