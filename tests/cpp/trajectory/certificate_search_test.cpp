/// The certificate against brute force: random pieces, and violations that no sampling sees.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "problem_count.hpp"
#include "trajectory/trajectory_fixtures.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {
namespace {

using testing::one_joint_piece;
using testing::random_piece;
using testing::uniform_limits;

/// The largest value of f on [0, 1]: samples, and a golden-section search about every one that is
/// not below its neighbours, the ends too. Reached values only.
double sampled_maximum(const std::function<double(double)>& f, int samples) {
  std::vector<double> values(static_cast<std::size_t>(samples) + 1);
  for (int i = 0; i <= samples; ++i) {
    values[static_cast<std::size_t>(i)] = f(static_cast<double>(i) / samples);
  }
  double best = *std::ranges::max_element(values);
  for (int i = 0; i <= samples; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i > 0 && values[at] < values[at - 1]) continue;
    if (i < samples && values[at] < values[at + 1]) continue;
    double low = std::max(0.0, static_cast<double>(i - 1) / samples);
    double high = std::min(1.0, static_cast<double>(i + 1) / samples);
    for (int step = 0; step < 60; ++step) {
      const double third = 0.381966 * (high - low);
      const double a = f(low + third);
      const double b = f(high - third);
      best = std::max({best, a, b});
      (a > b ? high : low) = a > b ? high - third : low + third;
    }
  }
  return best;
}

TEST(CertificateSearch, BoundsRandomPiecesFromAboveAndTightly) {
  // Limits of 1 make 1e-9 absolute below one, relative above.
  const JointLimits limits = uniform_limits(1, 1e3, 1.0, 1.0, 1.0);
  for (unsigned seed = 0; seed < problems(3000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const TrajectoryPiece piece = random_piece(random, 1);
    const Certificate certificate = certify(std::span(&piece, 1), limits);

    const auto check = [&](double bound, auto&& value) {
      const double found =
          sampled_maximum([&](double x) { return value(piece.at(x * piece.duration)); }, 600);
      // Horner's rounding in at() grows as its coefficients, up to 1e4 times the value.
      EXPECT_GE(bound, found - 1e-11 * std::max(1.0, std::abs(found)));
      EXPECT_LE(bound, found + 1e-9 * std::max(1.0, std::abs(found)));
    };
    check(certificate.velocity[0].value, [](const JointState& s) { return std::abs(s.qd[0]); });
    check(certificate.acceleration[0].value,
          [](const JointState& s) { return std::abs(s.qdd[0]); });
    check(certificate.jerk[0].value, [](const JointState& s) { return std::abs(s.qddd[0]); });
    check(certificate.position_max[0], [](const JointState& s) { return s.q[0]; });
    check(-certificate.position_min[0], [](const JointState& s) { return -s.q[0]; });
  }
}

TEST(CertificateSearch, BoundsManyJointsAndPiecesAsTheyWouldBeAlone) {
  for (unsigned seed = 0; seed < problems(300U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::vector<TrajectoryPiece> pieces;
    pieces.reserve(10);
    for (int i = 0; i < 10; ++i) pieces.push_back(random_piece(random, 6));
    const JointLimits limits = uniform_limits(6, 1e3, 1.0, 1.0, 1.0);
    const Certificate together = certify(pieces, limits);
    for (std::size_t joint = 0; joint < 6; ++joint) {
      double alone = 0.0;
      for (const TrajectoryPiece& piece : pieces) {
        alone = std::max(alone, certify(std::span(&piece, 1), limits).jerk[joint].value);
      }
      EXPECT_NEAR(together.jerk[joint].value, alone, 1e-9 * std::max(1.0, alone));
      // The place named is one where the value is reached.
      const Trajectory trajectory(pieces, limits);
      const double reached =
          std::max(std::abs(trajectory.at(together.jerk[joint].time).qddd[static_cast<int>(joint)]),
                   std::abs(trajectory.at(together.jerk[joint].time * (1 - 1e-14))
                                .qddd[static_cast<int>(joint)]));
      EXPECT_NEAR(reached, alone, 1e-6 * alone);
    }
  }
}

/// The minimum-jerk move over 1 rad and 1 s between the times t0 and t1, as a piece with u = x.
TrajectoryPiece part_of_smooth_move(double t0, double t1) {
  const std::array<double, 6>& c = testing::kSmoothStep;
  const double width = t1 - t0;
  // Taylor expansion about t0.
  std::array<double, 6> part{};
  for (std::size_t k = 0; k < 6; ++k) {
    double binomial = 1.0;
    for (std::size_t n = k; n < 6; ++n) {
      part[k] += binomial * c[n] * std::pow(t0, static_cast<double>(n - k));
      binomial *= static_cast<double>(n + 1) / static_cast<double>(n + 1 - k);
    }
    part[k] *= std::pow(width, static_cast<double>(k));
  }
  return one_joint_piece(width, part);
}

constexpr double kSampling = 1e-6;               ///< [s]
constexpr double kFrom = 0.3 + 0.2 * kSampling;  ///< between two samples, as kTo is
constexpr double kMiddle = 0.3 + 0.5 * kSampling;
constexpr double kTo = 0.3 + 0.8 * kSampling;

/// The move above in four pieces; the second goes off the curve by `height`, the third comes back.
/// All pieces meet in q, q̇ and q̈ whatever the height.
std::vector<TrajectoryPiece> move_with_spike(double height) {
  std::vector<TrajectoryPiece> pieces = {
      part_of_smooth_move(0.0, kFrom), part_of_smooth_move(kFrom, kMiddle),
      part_of_smooth_move(kMiddle, kTo), part_of_smooth_move(kTo, 1.0)};
  pieces[2].path[0][0] += height;
  for (std::size_t k = 3; k < 6; ++k) {
    pieces[1].path[k][0] += height * testing::kSmoothStep[k];
    pieces[2].path[k][0] -= height * testing::kSmoothStep[k];
  }
  return pieces;
}

JointLimits move_limits() { return uniform_limits(1, 2.0, 1.9, 5.8, 61.0); }

TEST(CertificateSearch, LetsTheUntouchedMovePass) {
  const Certificate certificate = certify(move_with_spike(0.0), move_limits());
  EXPECT_TRUE(certificate.holds()) << certificate.problems.front().describe();
}

TEST(CertificateSearch, FindsAViolationPlantedBetweenTwoSamplesAMicrosecondApart) {
  // 1e-18 rad cannot be seen in q, but its jerk is 60e-18 / (0.3e-6)³ = 2222 rad/s³; the larger
  // ones break acceleration and velocity too.
  struct Case {
    double height;
    std::vector<ErrorCode> breaks;
  };
  for (const auto& [height, breaks] :
       {Case{1e-18, {ErrorCode::kJerkLimit}},
        Case{1e-12, {ErrorCode::kJerkLimit, ErrorCode::kAccelerationLimit}},
        Case{1e-6,
             {ErrorCode::kJerkLimit, ErrorCode::kAccelerationLimit, ErrorCode::kVelocityLimit}}}) {
    SCOPED_TRACE(height);
    const JointLimits limits = move_limits();
    const Trajectory trajectory(move_with_spike(height), limits);

    // Sampling, and be it every microsecond, sees nothing.
    for (int i = 0; i <= 1'000'000; ++i) {
      const JointState state = trajectory.at(i * kSampling);
      ASSERT_LE(std::abs(state.qd[0]), limits.velocity[0]);
      ASSERT_LE(std::abs(state.qdd[0]), limits.acceleration[0]);
      ASSERT_LE(std::abs(state.qddd[0]), limits.jerk[0]);
    }
    const Certificate& certificate = trajectory.certificate();
    ASSERT_EQ(certificate.problems.size(), breaks.size());
    for (const ErrorCode code : breaks) {
      const auto problem = std::ranges::find(certificate.problems, code, &Problem::code);
      ASSERT_NE(problem, certificate.problems.end()) << to_string(code);
      EXPECT_GE(*problem->time, kFrom - 1e-12);
      EXPECT_LE(*problem->time, kTo + 1e-12);
    }
    EXPECT_NEAR(certificate.jerk[0].value, 60 * height / std::pow(kMiddle - kFrom, 3),
                1e-6 * certificate.jerk[0].value + 61.0);
  }
}

TEST(CertificateSearch, FindsASpikeWithinOnePieceOfARestingArm) {
  // u = 16 x²(1-x)² goes to 1 and back, q = height u²: C² with rest at both ends.
  for (const double duration : {0.9e-4, 1e-3}) {
    SCOPED_TRACE(duration);
    const double height = duration;
    std::vector<TrajectoryPiece> pieces = {
        one_joint_piece(0.5, {0, 0, 0, 0, 0, 0}),
        one_joint_piece(duration, {0, 0, 0, 0, 0, 0}, {0, 0, 16, -32, 16, 0}),
        one_joint_piece(0.5, {0, 0, 0, 0, 0, 0})};
    const JointLimits limits = uniform_limits(1, 1e6, 0.1, 1e12, 1e12);
    EXPECT_TRUE(certify(pieces, limits).holds());
    pieces[1].path[2][0] = height;
    const Certificate certificate = certify(pieces, limits);
    ASSERT_EQ(certificate.problems.size(), 1U);
    EXPECT_EQ(certificate.problems[0].code, ErrorCode::kVelocityLimit);
    EXPECT_NEAR(certificate.position_max[0], height, 1e-9);
    // 256 x⁴(1-x)⁴ is steepest at x = 1/2 - 1/(2√7).
    const double x = 0.5 - 0.5 / std::sqrt(7.0);
    const double slope = 256 * 4 * std::pow(x * (1 - x), 3) * (1 - 2 * x);
    EXPECT_NEAR(certificate.velocity[0].value, slope * height / duration, 1e-9);
  }
}

}  // namespace
}  // namespace viapoint
