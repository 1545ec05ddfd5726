#include "viapoint/realtime/push_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "problem_count.hpp"

namespace viapoint {
namespace {

constexpr unsigned kProblems = problems(5000U);

/// Gains that grow with the push, and a bound above which there is no way back.
struct Pushes {
  double strongest = 1.0;  ///< with a way back
  double whole = 1.0;      ///< gain of the share 1
  double bend = 1.0;       ///< power of the share in the gain

  [[nodiscard]] double gain(double share) const { return whole * std::pow(share, bend); }
};

struct Result {
  double share = 0.0, gain = 0.0;
  int trials = 0;
  PushSearch::Memory memory;
};

/// Searches as the governor does, at most `trials`.
Result search(const Pushes& pushes, const PushSearch::Memory& last, double missing, int trials) {
  PushSearch search(last, missing);
  Result result;
  for (; result.trials < trials && search.goes_on(); ++result.trials) {
    const double share = search.share();
    EXPECT_GT(share, 0.0);
    EXPECT_LE(share, 1.0);
    const double gain = pushes.gain(share);
    if (share > pushes.strongest) {
      search.refuse();
    } else if (gain > missing + PushSearch::kSameGain) {
      search.go_too_far(gain);
    } else {
      EXPECT_GE(gain, result.gain) << "what is accepted is better than before";
      search.accept(gain);
      result.share = share;
      result.gain = gain;
    }
  }
  result.memory = search.memory();
  return result;
}

TEST(PushSearch, TakesTheStrongestAtOnceWhereThatHasAWayBack) {
  const Result result = search({}, {}, 2.0, 10);
  EXPECT_EQ(result.share, 1.0);
  EXPECT_EQ(result.trials, 1);
}

TEST(PushSearch, HoldsALimitThatALittleLessThanTheStrongestKeeps) {
  for (const double strongest : {0.99, 0.98, 0.95, 0.9}) {
    const Result result = search({.strongest = strongest}, {}, 2.0, 10);
    EXPECT_LE(result.share, strongest);
    EXPECT_GE(result.share, strongest - 0.02) << strongest;
  }
}

TEST(PushSearch, FindsThePushThatGainsExactlyWhatIsMissing) {
  for (unsigned seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const Pushes pushes{.whole = 1.0 + 9.0 * unit(random), .bend = 1.0 + unit(random)};
    const Result result = search(pushes, {}, 1.0, 20);
    ASSERT_NEAR(result.gain, 1.0, 1e-9);
  }
}

TEST(PushSearch, GetsNearTheBestFromAnyMemoryInAFewCycles) {
  for (unsigned seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const Pushes pushes{.strongest = 0.05 + unit(random), .whole = 0.01 + unit(random)};
    PushSearch::Memory memory{std::max(1.0 / 64.0, unit(random)), 2.0 * unit(random)};
    const double best = std::min({pushes.whole, pushes.gain(pushes.strongest), 1.0});
    Result result;
    for (int cycle = 0; cycle < 3; ++cycle) {
      result = search(pushes, memory, 1.0, 7);
      memory = result.memory;
    }
    ASSERT_GE(result.gain, 0.9 * best - 0.02 * pushes.whole);
  }
}

TEST(PushSearch, GivesUpWhereNothingHasAWayBackAndTriesAgainFromThere) {
  const Result result = search({.strongest = 0.0}, {}, 1.0, 100);
  EXPECT_EQ(result.gain, 0.0);
  EXPECT_LT(result.trials, 20);
  const Result next = search({.strongest = 0.0}, result.memory, 1.0, 100);
  EXPECT_EQ(next.trials, 1) << "a cycle without a way back costs one trial";
  EXPECT_GT(search({}, next.memory, 2.0, 8).share, 0.5);
}

}  // namespace
}  // namespace viapoint
