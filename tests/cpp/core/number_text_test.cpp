#include "viapoint/core/number_text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

namespace viapoint {
namespace {

TEST(NumberText, IsShort) {
  EXPECT_EQ(number_text(1.0), "1");
  EXPECT_EQ(number_text(-0.1), "-0.1");
  EXPECT_EQ(number_text(1e300), "1e+300");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
}

TEST(NumberText, TellsNeighboursApart) {
  EXPECT_EQ(number_text(1.0000001), "1.0000001");
  EXPECT_NE(number_text(3.141593), number_text(std::nextafter(3.141593, 4.0)));
}

TEST(NumberText, ReadsBackToTheSameBits) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20'000; ++i) {
    const double value = std::bit_cast<double>(std::uint64_t{random()});
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(std::strtod(number_text(value).c_str(), nullptr), value) << i;
  }
}

TEST(RoundedText, LeavesOutTheDigitsOfRounding) {
  EXPECT_EQ(rounded_text(0.1 + 0.2), "0.3");
  EXPECT_EQ(rounded_text(160.00000001), "160.00000001");
  EXPECT_EQ(rounded_text(1234567.1), "1234567.1");
}

}  // namespace
}  // namespace viapoint
