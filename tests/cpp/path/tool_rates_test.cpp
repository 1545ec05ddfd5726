#include "viapoint/path/tool_rates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "path/random_arms.hpp"

namespace viapoint::testing {
namespace {

JointPiece random_piece(std::mt19937_64& random, int joints, double size) {
  std::normal_distribution<double> normal;
  JointPiece piece;
  piece.coefficients.resize(6, joints);
  for (int i = 0; i < joints; ++i) {
    piece.coefficients(0, i) = normal(random);
    for (int k = 1; k < 6; ++k) piece.coefficients(k, i) = size * normal(random);
  }
  piece.length = 0.7;
  return piece;
}

/// Value and slope by u of a rate.
struct At {
  Eigen::Vector3d value, slope;
};

At at(const ToolRate& rate, double u) {
  At result{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    const auto& c = rate.coefficients[static_cast<size_t>(axis)];
    for (size_t k = 6; k-- > 0;) {
      result.slope[axis] = result.slope[axis] * u + result.value[axis];
      result.value[axis] = result.value[axis] * u + c[k];
    }
  }
  return result;
}

/// Largest miss over its proven error, both of value and slope, over 60 places.
void expect_within_error(const ForwardKinematics& arm, const JointPiece& piece,
                         const ToolRates& rates) {
  for (int k = 0; k <= 60; ++k) {
    const double u = k / 60.0;
    const PathPoint point = piece.at(u * piece.length);
    const JointVector q1 = piece.length * point.q1;
    const JointVector q2 = piece.length * piece.length * point.q2;
    const ChainFrames frames = arm.frames(point.q);
    const Twist twist = arm.jacobian(frames) * q1;
    const Twist slope = arm.jacobian(frames) * q2 + arm.jacobian_rate(frames, q1) * q1;
    const At linear = at(rates.linear, u), angular = at(rates.angular, u);
    ASSERT_LE((linear.value - twist.head<3>()).norm(), rates.linear.error) << u;
    ASSERT_LE((angular.value - twist.tail<3>()).norm(), rates.angular.error) << u;
    ASSERT_LE((linear.slope - slope.head<3>()).norm(), rates.linear.slope_error) << u;
    ASSERT_LE((angular.slope - slope.tail<3>()).norm(), rates.angular.slope_error) << u;
  }
}

TEST(ToolRates, StayWithinTheirProvenErrorOnRandomArmsAndPieces) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const int joints = 1 + static_cast<int>(seed % 8);
    const ForwardKinematics arm = random_arm(random, joints);
    const double size = std::pow(10.0, -3.0 + 3.5 * static_cast<double>(seed % 97) / 96.0);
    const JointPiece piece = random_piece(random, joints, size);
    expect_within_error(arm, piece, tool_rates(arm, piece));
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(ToolRates, HalvePiecesUntilTheirErrorIsSmall) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const ForwardKinematics arm = random_arm(random, 6);
    JointPath path;
    path.append(random_piece(random, 6, 0.02));
    path.append(random_piece(random, 6, 0.02));
    JointPath limited;
    for (JointPiece piece : path.pieces()) {
      piece.tool.speed = 0.1;
      piece.tool.hold_speed = seed % 2 == 0;
      limited.append(piece);
    }
    EXPECT_TRUE(with_tool_rates(arm, path).rates.empty());
    const PathWithTool with_tool = with_tool_rates(arm, limited);
    ASSERT_EQ(with_tool.rates.size(), with_tool.path.pieces().size());
    EXPECT_NEAR(with_tool.path.length(), path.length(), 1e-12);
    for (size_t k = 0; k < with_tool.rates.size(); ++k) {
      const JointPiece& piece = with_tool.path.pieces()[k];
      const double s = with_tool.path.start_of(k) + 0.3 * piece.length;
      EXPECT_LE((piece.at(0.3 * piece.length).q - path.at(s).q).cwiseAbs().maxCoeff(), 1e-12);
      const ToolRate& rate = with_tool.rates[k].linear;
      const double size = at(rate, 0.5).value.norm();
      EXPECT_LE(rate.error, (seed % 2 == 0 ? 1e-6 : 1e-2) * size);
    }
  }
}

}  // namespace
}  // namespace viapoint::testing
