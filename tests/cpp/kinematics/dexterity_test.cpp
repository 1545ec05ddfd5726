// Measures of dexterity, and where the tool can be.
#include "viapoint/kinematics/dexterity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinematics/arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/workspace.hpp"

namespace viapoint {
namespace {

TEST(Dexterity, OfTheTwoLinkArmFollowsItsFormulas) {
  // J = [-s1 - 2 s12, -2 s12; c1 + 2 c12, 2 c12] with links of 1 m and 2 m: det J = 2 sin q2.
  const RobotPtr robot = arm("two_link");
  std::mt19937_64 generator(101);
  for (int problem = 0; problem < 500; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const Dexterity found = dexterity(*robot, q);
    EXPECT_NEAR(found.yoshikawa, std::abs(2.0 * std::sin(q[1])), 1e-12);
    // σ1² + σ2² = ‖J‖², σ1 σ2 = |det J|.
    const double sum = 1.0 + 8.0 + 4.0 * std::cos(q[1]);
    const double product = std::abs(2.0 * std::sin(q[1]));
    const double greatest = std::sqrt(0.5 * (sum + std::sqrt(sum * sum - 4.0 * product * product)));
    EXPECT_NEAR(found.linear.lengths[0], greatest, 1e-12);
    EXPECT_NEAR(found.linear.lengths[1], product / greatest, 1e-9);
    EXPECT_NEAR(found.linear.lengths[2], 0.0, 1e-12);
    EXPECT_NEAR(found.isotropy, product / (greatest * greatest), 1e-9);
    EXPECT_NEAR(found.condition * found.isotropy, 1.0, 1e-12);
    EXPECT_NEAR(found.asada, found.isotropy, 1e-12);  // both joints accelerate alike
  }
}

TEST(Dexterity, EllipsoidsHoldTheRatesOfUnitJointRates) {
  for (const char* name : kArms) {
    SCOPED_TRACE(name);
    const RobotPtr robot = arm(name);
    std::mt19937_64 generator(102);
    for (int problem = 0; problem < 100; ++problem) {
      const JointVector q = random_joints(*robot, generator);
      const Dexterity found = dexterity(*robot, q);
      const JointVector rates = JointVector::Random(robot->joints()).normalized();
      const Twist twist = robot->jacobian(q) * rates;
      for (const bool angular : {false, true}) {
        const VelocityEllipsoid& ellipsoid = angular ? found.angular : found.linear;
        const Eigen::Vector3d rate = angular ? twist.tail<3>() : twist.head<3>();
        const Eigen::Vector3d along = ellipsoid.axes.transpose() * rate;
        double inside = 0.0;
        for (int i = 0; i < 3; ++i) {
          if (ellipsoid.lengths[i] < 1e-9) {
            ASSERT_NEAR(along[i], 0.0, 1e-9);
          } else {
            inside += std::pow(along[i] / ellipsoid.lengths[i], 2);
          }
        }
        ASSERT_LE(inside, 1.0 + 1e-9);
      }
    }
  }
}

TEST(Dexterity, IsLostAtASingularPose) {
  const RobotPtr robot = arm("puma560");
  JointVector q(6);
  q << 0.3, -0.4, 0.5, 0.6, 0.0, 0.2;
  const Dexterity found = dexterity(*robot, q);
  EXPECT_LT(found.yoshikawa, 1e-12);
  EXPECT_LT(found.isotropy, 1e-12);
  EXPECT_GT(found.condition, 1e12);
  q[4] = 0.9;
  EXPECT_GT(dexterity(*robot, q).isotropy, 1e-3);
}

TEST(Reach, OfTheTwoLinkArmIsARing) {
  // Links of 1 m and 2 m: from 1 m to 3 m in every direction of the plane, nothing out of it.
  const RobotPtr robot = arm("two_link");
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (double angle = -3.0; angle < 3.0; angle += 0.7) {
    SCOPED_TRACE(angle);
    const auto found =
        reach(*robot, origin, Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0), std::nullopt);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].from, 1.0, 1e-8);
    EXPECT_NEAR(found[0].to, 3.0, 1e-8);
  }
  EXPECT_TRUE(reach(*robot, Eigen::Vector3d(0.0, 0.0, 0.1), Eigen::Vector3d::UnitX(), std::nullopt)
                  .empty());
}

TEST(Reach, OfTheScaraFollowsItsFormula) {
  // r² = a1² + a2² + 2 a1 a2 cos q2 with |q2| ≤ 150°; the slide moves it up and down only.
  const RobotPtr robot = arm("scara");
  const double inner = std::sqrt(0.16 + 0.09 + 0.24 * std::cos(150.0 * kDegree));
  const auto found =
      reach(*robot, Eigen::Vector3d(0.0, 0.0, 0.25), Eigen::Vector3d(1.0, 0.0, 0.0), std::nullopt);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].from, inner, 1e-8);
  EXPECT_NEAR(found[0].to, 0.7, 1e-8);
  const auto down =
      reach(*robot, Eigen::Vector3d(0.5, 0.0, 0.5), -Eigen::Vector3d::UnitZ(), std::nullopt);
  ASSERT_EQ(down.size(), 1u);
  EXPECT_NEAR(down[0].from, 0.15, 1e-8);  // the slide from 0.05 m, 0.1 m to the tool
  EXPECT_NEAR(down[0].to, 0.40, 1e-8);
}

TEST(Reach, WithAnOrientationIsNoMoreThanWithout) {
  const RobotPtr robot = arm("puma560");
  const Eigen::Vector3d direction(1.0, 0.3, 0.2);
  const auto any = reach(*robot, Eigen::Vector3d::Zero(), direction, std::nullopt);
  const auto forward =
      reach(*robot, Eigen::Vector3d::Zero(), direction, rotation_exp(Eigen::Vector3d(0, 1.5, 0)));
  ASSERT_FALSE(any.empty());
  ASSERT_FALSE(forward.empty());
  EXPECT_LE(forward.back().to, any.back().to + 1e-9);
  // Stretched, 0.149 m aside of axis 1.
  const double length = std::hypot(0.432 + std::hypot(0.433, 0.02), 0.149);
  EXPECT_NEAR(any.back().to, length, 1e-6);
}

TEST(Reach, RefusesARayWithoutDirection) {
  try {
    (void)reach(*arm("puma560"), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), std::nullopt);
    FAIL() << "answered";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
  }
}

TEST(Scara, JointRatesHaveTheirClosedForm) {
  // With φ = q1 − q2 the position is a1 (c1, s1) + a2 (cφ, sφ), so that, with D = a1 a2 sin q2,
  // q̇1 = −a2 (cφ ẋ + sφ ẏ) / D and q̇2 = q̇1 − a1 (c1 ẋ + s1 ẏ) / D.
  const RobotPtr robot = arm("scara");
  std::mt19937_64 generator(103);
  int compared = 0;
  for (int problem = 0; problem < 500; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    if (std::abs(std::sin(q[1])) < 0.05) continue;
    ++compared;
    const JointVector rates = JointVector::Random(4);
    const Twist twist = robot->jacobian(q) * rates;
    const double phi = q[0] - q[1];
    const double fore = 0.3 * (std::cos(phi) * twist[0] + std::sin(phi) * twist[1]);
    const double upper = 0.4 * (std::cos(q[0]) * twist[0] + std::sin(q[0]) * twist[1]);
    const double d = 0.4 * 0.3 * std::sin(q[1]);
    ASSERT_NEAR(-fore / d, rates[0], 1e-9);
    ASSERT_NEAR(-(fore + upper) / d, rates[1], 1e-9);
    ASSERT_NEAR(-twist[2], rates[2], 1e-12);
    ASSERT_NEAR(twist[5], rates[0] - rates[1] - rates[3], 1e-12);
  }
  EXPECT_GT(compared, 400);
}

}  // namespace
}  // namespace viapoint
