// Jogging in virtual time, with calls that come as they like.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "problem_count.hpp"
#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr double kSeconds = 2e-3;

JointLimits walled_limits() {
  JointLimits limits = even_limits(2, 2.0, 20.0, 200.0);
  limits.position_min = JointVector::Constant(2, -0.3);
  limits.position_max = JointVector::Constant(2, 0.4);
  return limits;
}

TEST(SimulateJog, KeepsEveryLimitWheneverItIsCalled) {
  const JointLimits limits = walled_limits();
  for (unsigned seed = 0; seed < problems(300U); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    std::vector<TimedJog> calls;
    double last = 0.0;
    for (int i = 0; i < 40; ++i) {
      const double now = 2.0 * std::abs(any(random));
      last = std::max(last, now);
      calls.push_back({now, JointVector::Zero(2)});
      for (int joint = 0; joint < 2; ++joint) calls.back().velocity[joint] = 2.0 * any(random);
    }
    const auto log = simulate_jog(limits, JointVector::Zero(2), calls, kCycle);
    // The last call counts for 250 ms; then it takes up to 0.1 s until the acceleration is gone,
    // and 0.1 s + 0.1 s to stop from 2 rad/s.
    EXPECT_LE(static_cast<double>(log.size()) * kSeconds, last + 0.25 + 0.3 + 4.0 * kSeconds);
    EXPECT_EQ(log.back().state, RunState::kIdle);
    EXPECT_EQ(log.back().qd.cwiseAbs().maxCoeff(), 0.0);
    for (std::size_t k = 0; k < log.size(); ++k) {
      ASSERT_EQ(log[k].cycle, k);
      EXPECT_LE(log[k].q.maxCoeff(), 0.4 + 1e-12);
      EXPECT_GE(log[k].q.minCoeff(), -0.3 - 1e-12);
      EXPECT_LE(log[k].qd.cwiseAbs().maxCoeff(), 2.0 * (1.0 + 1e-12));
      EXPECT_LE(log[k].qdd.cwiseAbs().maxCoeff(), 20.0 * (1.0 + 1e-12));
      EXPECT_LE(log[k].qddd.cwiseAbs().maxCoeff(), 200.0 * (1.0 + 1e-12));
      if (k == 0) continue;
      // What is between two cycles is no jump either.
      EXPECT_LE((log[k].q - log[k - 1].q).cwiseAbs().maxCoeff(), 2.0 * kSeconds * (1.0 + 1e-9));
      EXPECT_LE((log[k].qd - log[k - 1].qd).cwiseAbs().maxCoeff(), 20.0 * kSeconds * (1.0 + 1e-9));
      EXPECT_LE((log[k].qdd - log[k - 1].qdd).cwiseAbs().maxCoeff(),
                200.0 * kSeconds * (1.0 + 1e-9));
    }
    if (HasFailure()) return;
  }
}

TEST(SimulateJog, TakesACallInItsCycleWhateverTheirOrder) {
  const JointVector one = JointVector::Constant(2, 1.0);
  const auto log = simulate_jog(walled_limits(), JointVector::Zero(2),
                                {{0.02, JointVector::Zero(2)}, {0.01, one}}, kCycle);
  EXPECT_EQ(log[4].state, RunState::kIdle);
  EXPECT_EQ(log[5].state, RunState::kJogging);
  EXPECT_GT(log[9].qdd[0], 0.0);
  EXPECT_LT(log[11].qddd[0], 0.0);
}

TEST(SimulateJog, NamesWhatCannotBe) {
  const JointLimits limits = walled_limits();
  const JointVector rest = JointVector::Zero(2);
  const auto code_of = [&](const JointVector& start, double time, double velocity,
                           std::chrono::nanoseconds cycle) {
    try {
      (void)simulate_jog(limits, start, {{time, JointVector::Constant(2, velocity)}}, cycle);
    } catch (const MotionError& error) {
      return error.code();
    }
    return ErrorCode::kInternal;
  };
  EXPECT_EQ(code_of(rest, 0.0, 2.1, kCycle), ErrorCode::kVelocityLimit);
  EXPECT_EQ(code_of(rest, 0.0, NAN, kCycle), ErrorCode::kBadArgument);
  // A nanosecond would ask for 16 GB.
  EXPECT_EQ(code_of(rest, 0.0, 0.1, std::chrono::nanoseconds(1)), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(rest, -1.0, 1.0, kCycle), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(rest, 1e9, 1.0, kCycle), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(rest, 0.0, 1.0, std::chrono::nanoseconds(0)), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(JointVector::Zero(3), 0.0, 1.0, kCycle), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(JointVector::Constant(2, INFINITY), 0.0, 1.0, kCycle), ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace viapoint
