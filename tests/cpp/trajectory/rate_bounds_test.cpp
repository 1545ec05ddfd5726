#include "trajectory/rate_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "problem_count.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {
namespace {

struct Case {
  TrajectoryPiece piece;
  Quintic path{};
};

/// A quintic in a quintic that stays in [0, 1].
Case random_case(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Case result;
  result.piece.joints = 1;
  result.piece.duration = std::pow(10.0, 2.0 * unit(random));
  const double wobble = 0.1 * unit(random);
  result.piece.timing = {0.0, 0.8, wobble, -wobble, 0.1, 0.1};
  for (std::size_t k = 0; k < 6; ++k) {
    result.path[k] = unit(random);
    result.piece.path[k][0] = result.path[k];
  }
  return result;
}

Rates sampled(const TrajectoryPiece& piece, double from, double to) {
  Rates most;
  for (int k = 0; k <= 1000; ++k) {
    const JointState state = piece.at(piece.duration * (from + (to - from) * k / 1000.0));
    most.velocity = std::max(most.velocity, std::abs(state.qd[0]));
    most.acceleration = std::max(most.acceleration, std::abs(state.qdd[0]));
    most.jerk = std::max(most.jerk, std::abs(state.qddd[0]));
  }
  return most;
}

TEST(TimingSamples, BoundsAreNeverBelowWhatIsReached) {
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(2000); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Case problem = random_case(seed);
    const double from = 0.25 * static_cast<double>(seed % 4),
                 to = seed % 3 == 0 ? 1.0 : from + 0.25;
    const Rates most = sampled(problem.piece, from, to);
    for (const int parts : {1, 4, TimingSamples::kMostParts}) {
      const TimingSamples samples(problem.piece.timing, problem.piece.duration, parts, from, to);
      const Rates reached = samples.reached(problem.path), more = samples.between(problem.path);
      ASSERT_GE(reached.velocity + more.velocity, most.velocity);
      ASSERT_GE(reached.acceleration + more.acceleration, most.acceleration);
      ASSERT_GE(reached.jerk + more.jerk, most.jerk);
    }
  }
}

TEST(TimingSamples, BoundsTightenFourfoldWithTwiceTheParts) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Case problem = random_case(seed);
    const auto gap = [&](int parts) {
      return TimingSamples(problem.piece.timing, problem.piece.duration, parts)
          .between(problem.path)
          .jerk;
    };
    EXPECT_NEAR(gap(8) / gap(4), 0.25, 1e-9);
    EXPECT_NEAR(gap(16) / gap(8), 0.25, 1e-9);
  }
}

}  // namespace
}  // namespace viapoint
