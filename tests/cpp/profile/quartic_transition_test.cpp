#include "viapoint/profile/quartic_transition.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "golden.hpp"
#include "problem_count.hpp"
#include "profile/law_checks.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

TEST(QuarticTransitions, GoldenTextbookSection3JointMove) {
  const auto puma = golden("puma560");
  const auto& joints = puma.at("joints_deg");
  const auto& timing = puma.at("timing_s");
  const double before = timing.at("t_AB"), after = timing.at("t_BC");
  for (size_t j = 0; j < 6; ++j) {
    const std::array points{joints.at("A")[j].get<double>(), joints.at("B")[j].get<double>(),
                            joints.at("C")[j].get<double>()};
    const AxisLaw law =
        quartic_transitions(points, std::array{before, after}, timing.at("t_acc").get<double>());
    for (const auto& row : puma.at("joint_move_deg")) {
      const AxisState state = law.at(row.at("t").get<double>() + before);
      EXPECT_NEAR(state.q, row.at("q")[j].get<double>(), 1e-10) << row.at("t") << " joint " << j;
      EXPECT_NEAR(state.qd, row.at("qd")[j].get<double>(), 1e-10) << row.at("t") << " joint " << j;
      EXPECT_NEAR(state.qdd, row.at("qdd")[j].get<double>(), 1e-9) << row.at("t") << " joint " << j;
    }
    expect_continuous(law, 2);
  }
}

TEST(QuarticTransitions, AreContinuousInAccelerationThroughAnyNumberOfPoints) {
  for (int seed = 0; seed < problems(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-3.0, 3.0);
    std::vector<double> points{any(random)}, durations;
    const int segments = 2 + static_cast<int>(random() % 8);
    double shortest = INFINITY;
    for (int i = 0; i < segments; ++i) {
      points.push_back(any(random));
      durations.push_back(std::exp(0.3 * any(random)));
      shortest = std::min(shortest, durations.back());
    }
    const double t_acc = 0.5 * shortest * std::uniform_real_distribution(0.05, 1.0)(random);
    const AxisLaw law = quartic_transitions(points, durations, t_acc);
    expect_continuous(law, 2, 1e-9);
    expect_extremes_hold(law);
    EXPECT_EQ(law.at(0.0).q, points.front());
    EXPECT_NEAR(law.at(law.end()).q, points.back(), 1e-11);
    EXPECT_NEAR(law.at(0.0).qd, (points[1] - points[0]) / durations[0], 1e-12);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(QuarticTransitions, NamesTheLargestTransitionThatFits) {
  const std::array points{0.0, 1.0, 2.0, 0.0};
  const std::array durations{1.0, 0.6, 1.0};
  EXPECT_NO_THROW(static_cast<void>(quartic_transitions(points, durations, 0.3)));
  try {
    static_cast<void>(quartic_transitions(points, durations, 0.31));
    FAIL() << "accepted";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.problem().limit, 0.3);
    EXPECT_NE(std::string(error.what()).find("segment 1"), std::string::npos) << error.what();
  }
  EXPECT_THROW(static_cast<void>(quartic_transitions(points, durations, 0.0)), MotionError);
  EXPECT_THROW(static_cast<void>(quartic_transitions(points, std::array{1.0, 0.0, 1.0}, 0.1)),
               MotionError);
  EXPECT_THROW(static_cast<void>(quartic_transitions(std::array{1.0}, {}, 0.1)), MotionError);
}

TEST(QuarticTransitions, TwoPointsMakeALine) {
  const AxisLaw law = quartic_transitions(std::array{1.0, 3.0}, std::array{4.0}, 0.2);
  EXPECT_EQ(law.parts().size(), 1u);
  EXPECT_EQ(law.at(2.0).q, 2.0);
  EXPECT_EQ(law.at(4.0).qd, 0.5);
}

}  // namespace
}  // namespace viapoint
