#include "realtime/output_panel.hpp"

#include <gtest/gtest.h>

#include <random>
#include <thread>

namespace viapoint {
namespace {

TEST(OutputPanel, LeavesEachOutputAsWhoeverChangedItLast) {
  OutputSwitches hand;
  OutputPanel panel;
  const auto cycle = [&](std::uint64_t motion) {
    panel.follow(motion);
    panel.switch_by_hand(hand);
    return panel.sent();
  };
  EXPECT_EQ(cycle(0b0001), 0b0001U);
  hand.set(0b0110, 0b0010);
  EXPECT_EQ(cycle(0b0001), 0b0011U);
  hand.set(0b0001, 0b0000);
  EXPECT_EQ(cycle(0b0001), 0b0010U);
  EXPECT_EQ(cycle(0b0101), 0b0110U) << "the motion changed output 2 only";
  EXPECT_EQ(cycle(0b0100), 0b0110U) << "off already";
  EXPECT_EQ(cycle(0b0101), 0b0111U);
  EXPECT_EQ(cycle(0b0111), 0b0111U) << "on already";
  EXPECT_EQ(cycle(0b0101), 0b0101U);
}

TEST(OutputPanel, TakesTheNewestOfTwoSwitchesInOneCycle) {
  for (std::uint64_t seed = 0; seed < 10'000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    OutputSwitches hand;
    std::uint64_t expected = random(), sent = expected;
    for (int cycle = 0; cycle < 3; ++cycle) {
      for (auto calls = random() % 4; calls > 0; --calls) {
        const std::uint64_t mask = random() & random(), values = random();
        hand.set(mask, values);
        expected = (expected & ~mask) | (values & mask);
      }
      sent = hand.take(sent);
      ASSERT_EQ(sent, expected);
    }
  }
}

TEST(OutputPanel, LosesNoSwitchThatComesWhileTheTickTakes) {
  OutputSwitches hand;
  std::uint64_t sent = 0;
  std::uint64_t last = 0;
  std::thread switcher([&] {
    std::mt19937_64 random(1);
    for (int i = 0; i < 100'000; ++i) hand.set(~0ULL, last = random());
  });
  for (int i = 0; i < 10'000; ++i) sent = hand.take(sent);
  switcher.join();
  EXPECT_EQ(hand.take(sent), last);
}

}  // namespace
}  // namespace viapoint
