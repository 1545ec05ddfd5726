#include "viapoint/core/number_text.hpp"

#include <array>
#include <charconv>

namespace viapoint {

std::string number_text(double value) {
  std::array<char, 32> digits{};  // 24 are needed at most
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

}  // namespace viapoint
