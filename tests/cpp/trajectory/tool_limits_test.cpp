#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "path/random_arms.hpp"
#include "problem_count.hpp"
#include "trajectory/time_parameterizer_problems.hpp"
#include "viapoint/path/tool_rates.hpp"
#include "viapoint/trajectory/certificate.hpp"
#include "viapoint/trajectory/time_parameterizer.hpp"
#include "viapoint/trajectory/tool_certificate.hpp"

namespace viapoint::testing {
namespace {

constexpr double kShare = 1.0 + 1e-9;

/// Shares of the tool's limits at an instant, by the arm's own kinematics.
struct ToolShares {
  double speed = 0.0, acceleration = 0.0, angular_speed = 0.0, angular_acceleration = 0.0;

  void include(const ToolShares& other) {
    speed = std::max(speed, other.speed);
    acceleration = std::max(acceleration, other.acceleration);
    angular_speed = std::max(angular_speed, other.angular_speed);
    angular_acceleration = std::max(angular_acceleration, other.angular_acceleration);
  }
  [[nodiscard]] double worst() const {
    return std::max({speed, acceleration, angular_speed, angular_acceleration});
  }
};

ToolShares shares_at(const ForwardKinematics& arm, const JointState& state,
                     const ToolLimits& limits) {
  const ChainFrames frames = arm.frames(state.q);
  const Twist rate = arm.jacobian(frames) * state.qd;
  const Twist change =
      arm.jacobian(frames) * state.qdd + arm.jacobian_rate(frames, state.qd) * state.qd;
  return {rate.head<3>().norm() / limits.speed, change.head<3>().norm() / limits.acceleration,
          rate.tail<3>().norm() / limits.angular_speed,
          change.tail<3>().norm() / limits.angular_acceleration};
}

/// Limits of about the size of what the arm does without any; some of them left out.
ToolLimits random_tool_limits(Random& random) {
  ToolLimits limits;
  const auto maybe = [&](double& limit) {
    if (random() % 3 != 0) limit = decades(random, 0.03, 30.0);
  };
  maybe(limits.speed);
  maybe(limits.acceleration);
  maybe(limits.angular_speed);
  maybe(limits.angular_acceleration);
  return limits;
}

JointPath random_path(Random& random, int joints, std::uint64_t seed) {
  if (seed % 2 == 0) {
    return cornered_path(random_walk(random, joints, 1 + static_cast<int>(seed % 3), 0.02, 0.5),
                         decades(random, 1e-3, 0.1));
  }
  return random_spline(random, joints, 1 + static_cast<int>(seed % 2), decades(random, 0.02, 0.3),
                       decades(random, 0.1, 1.0));
}

TEST(ToolLimits, HoldAtTheToolOnRandomArmsAndPaths) {
  int ruled = 0, count = 0;
  for (std::uint64_t seed = 0; seed < problems(1000U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const int joints = 2 + static_cast<int>(seed % 6);
    const ForwardKinematics arm = random_arm(random, joints);
    const JointLimits limits = random_limits(random, joints, 0.5);
    JointPath path;
    const JointPath plain = random_path(random, joints, seed);
    for (JointPiece piece : plain.pieces()) {
      piece.tool = random_tool_limits(random);
      if (!piece.tool.any()) piece.tool.speed = 1.0;
      path.append(piece);
    }
    const PathWithTool with_tool = with_tool_rates(arm, path);
    const TimedPath timed = parameterize(with_tool.path, limits, with_tool.rates);
    ASSERT_EQ(timed.origin.size(), timed.pieces.size());
    const Certificate certificate = certify(timed.pieces, limits);
    ASSERT_TRUE(certificate.holds()) << certificate.problems.front().describe();

    ToolCertifier certifier;
    ToolShares sampled;
    double time = 0.0;
    for (size_t k = 0; k < timed.pieces.size(); ++k) {
      const TrajectoryPiece& piece = timed.pieces[k];
      const ToolRates& rates = with_tool.rates[timed.origin[k]];
      certifier.add(piece, rates, time);
      time += piece.duration;
      for (int i = 0; i <= 16; ++i) {
        const JointState state = piece.at(piece.duration * i / 16.0);
        sampled.include(shares_at(arm, state, rates.limits));
      }
    }
    ASSERT_LE(sampled.worst(), kShare);
    const ToolExtrema& proven = certifier.extrema();
    const std::vector<std::pair<Extremum, double>> all{
        {proven.speed, sampled.speed},
        {proven.acceleration, sampled.acceleration},
        {proven.angular_speed, sampled.angular_speed},
        {proven.angular_acceleration, sampled.angular_acceleration}};
    for (const auto& [bound, reached] : all) {
      ASSERT_LE(bound.share, 1.0 + kLimitSlack);
      ASSERT_GE(bound.share, reached * (1.0 - 1e-12));
      ASSERT_LE(bound.time, time);
    }
    // The limits are used, not only kept.
    double used = sampled_share(timed.pieces, limits, 16);
    used = std::max(used, sampled.worst());
    ASSERT_GE(used, 0.9);
    ++count;
    ruled += sampled.worst() >= 0.9 ? 1 : 0;
  }
  EXPECT_GE(ruled, count / 2) << "the tool's limits are to matter in this test";
}

TEST(ToolLimits, AreUsedAllAlongAnArc) {
  // One link of a metre: the tool's acceleration is r √(θ̈² + θ̇⁴), its speed r θ̇.
  ChainJoint joint;
  Pose tool = Pose::Identity();
  tool.translate(Eigen::Vector3d(1.0, 0.0, 0.0));
  const std::vector<ChainJoint> chain{joint};
  const ForwardKinematics arm(chain, tool);
  const JointLimits limits =
      limits_of(JointVector::Constant(1, 100.0), JointVector::Constant(1, 1e3),
                JointVector::Constant(1, 1e5));
  JointPiece piece = JointPiece::line(JointVector::Zero(1), JointVector::Constant(1, 6.0), 6.0);
  piece.tool.acceleration = 4.0;  // so θ̇ <= 2
  JointPath path;
  path.append(piece);
  const PathWithTool with_tool = with_tool_rates(arm, path);
  const TimedPath timed = parameterize(with_tool.path, limits, with_tool.rates);
  // θ̇² = b: b'/2 = √(16 − b²), so b = 4 sin 2θ up to θ = π/4, and the same backwards.
  double ramp = 0.0;
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) {  // θ = x²: the integrand stays finite at rest
    const double x = (k + 0.5) / kSteps * std::sqrt(kPi / 4.0);
    ramp += 2.0 * x / std::sqrt(4.0 * std::sin(2.0 * x * x)) * std::sqrt(kPi / 4.0) / kSteps;
  }
  const double quickest = 2.0 * ramp + (6.0 - kPi / 2.0) / 2.0;
  EXPECT_GE(duration_of(timed.pieces), quickest);
  EXPECT_LE(duration_of(timed.pieces), 1.02 * quickest);
}

}  // namespace
}  // namespace viapoint::testing
