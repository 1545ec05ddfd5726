#include "viapoint/kinematics/robot_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "kinematics/arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

class EveryArm : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(RobotModel, EveryArm, testing::ValuesIn(kArms),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(EveryArm, KdlAndOurChainAgree) {
  const RobotPtr robot = arm(GetParam());
  std::mt19937_64 generator(1);
  for (int problem = 0; problem < 3000; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    ASSERT_LT(pose_distance(robot->fk(q), robot->forward().pose(q)), 1e-12);
    const Jacobian ours = robot->forward().jacobian(robot->forward().frames(q));
    ASSERT_LT((robot->jacobian(q) - ours).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST_P(EveryArm, AnswersFromManyThreadsAtOnce) {
  const RobotPtr robot = arm(GetParam());
  std::mt19937_64 generator(2);
  const JointVector q = random_joints(*robot, generator);
  const Pose pose = robot->fk(q);
  const Jacobian jacobian = robot->jacobian(q);
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  for (int& count : wrong) {
    threads.emplace_back([&] {
      for (int call = 0; call < 500; ++call) {
        if (robot->fk(q).matrix() != pose.matrix() || robot->jacobian(q) != jacobian) ++count;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const int count : wrong) EXPECT_EQ(count, 0);
}

TEST_P(EveryArm, HasLimitsAndSources) {
  const RobotPtr robot = arm(GetParam());
  EXPECT_NO_THROW(robot->limits().validate());
  EXPECT_EQ(robot->name(), GetParam());
  EXPECT_FALSE(robot->description().title.empty());
  EXPECT_FALSE(robot->description().sources.empty());
  if (robot->name() != "panda") {
    EXPECT_FALSE(robot->description().chosen.empty());
  }
}

TEST(RobotModel, RefusesJointVectorsOfTheWrongSizeOrNotFinite) {
  const RobotPtr robot = arm("puma560");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    JointVector q = JointVector::Zero(6);
    q[3] = bad;
    try {
      (void)robot->fk(q);
      FAIL() << "accepted";
    } catch (const MotionError& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
      EXPECT_EQ(error.problem().joint, 3);
    }
  }
  EXPECT_THROW((void)robot->fk(JointVector::Zero(5)), MotionError);
  EXPECT_THROW((void)robot->jacobian(JointVector::Zero(7)), MotionError);
  EXPECT_THROW((void)robot->manipulability(JointVector::Zero(7)), MotionError);
  EXPECT_THROW((void)robot->singularity(JointVector::Zero(7)), MotionError);
}

TEST(RobotModel, TwoLinkManipulabilityIsTheTextbooks) {
  // Textbook §5: m = a1 a2 |sin θ2|, largest at ±90°.
  const RobotPtr robot = arm("two_link");
  for (double q2 = -3.0; q2 <= 3.0; q2 += 0.1) {
    EXPECT_NEAR(robot->manipulability(Eigen::Vector2d(0.3, q2)), 2.0 * std::abs(std::sin(q2)),
                1e-12);
  }
}

TEST(RobotModel, ManipulabilityOfSixJointsIsTheDeterminant) {
  std::mt19937_64 generator(3);
  for (const char* name : {"puma560", "ur5e"}) {
    const RobotPtr robot = arm(name);
    for (int problem = 0; problem < 500; ++problem) {
      SCOPED_TRACE(problem);
      const JointVector q = random_joints(*robot, generator);
      const Eigen::Matrix<double, 6, 6> jacobian = robot->jacobian(q);
      ASSERT_NEAR(robot->manipulability(q), std::abs(jacobian.determinant()), 1e-12);
    }
  }
}

TEST(RobotModel, ManipulabilityOfShortArmsTakesTheRowsTheyMove) {
  // The cylindrical arm moves the position alone: m = d3. SCARA: m = a1 a2 |sin q2|.
  EXPECT_NEAR(arm("rpp")->manipulability(Eigen::Vector3d(0.4, 0.2, 0.7)), 0.7, 1e-12);
  EXPECT_NEAR(arm("scara")->manipulability(Eigen::Vector4d(0.4, 0.9, 0.1, 0.3)),
              0.4 * 0.3 * std::sin(0.9), 1e-12);
}

TEST(RobotModel, NamesThePumasSingularities) {
  const RobotPtr robot = arm("puma560");
  JointVector q(6);
  q << 0.1, 0.4, 0.6, 0.3, 0.02, 0.5;
  Singularity found = robot->singularity(q);
  EXPECT_EQ(found.name, "wrist");
  EXPECT_NEAR(found.distance, 0.02, 1e-12);

  // Stretched: forearm (0.433, and −0.02 aside) in line with the upper arm.
  q << 0.1, 0.4, std::atan2(0.433, 0.02) - kPi + 0.01, 0.3, 0.9, 0.5;
  bool elbow_found = false;
  for (double q3 = -2.3; q3 < 2.3; q3 += 1e-3) {
    q[2] = q3;
    found = robot->singularity(q);
    if (found.name != "elbow" || found.distance > 1e-3) continue;
    elbow_found = true;
    EXPECT_LT(found.manipulability, 1e-3);
  }
  EXPECT_TRUE(elbow_found);

  bool shoulder_found = false;
  q[2] = 0.6;
  for (double q2 = -2.1; q2 < 2.1; q2 += 1e-3) {
    q[1] = q2;
    found = robot->singularity(q);
    if (found.name != "shoulder" || found.distance > 1e-3) continue;
    shoulder_found = true;
    EXPECT_LT(found.manipulability, 1e-3);
  }
  EXPECT_TRUE(shoulder_found);

  q << 0.1, 0.4, 0.6, 0.3, 0.9, 0.5;
  EXPECT_EQ(robot->singularity(q).name, "none");
}

TEST(RobotModel, SingularityDistanceVanishesWithTheDeterminant) {
  const RobotPtr robot = arm("puma560");
  std::mt19937_64 generator(5);
  for (int problem = 0; problem < 2000; ++problem) {
    SCOPED_TRACE(problem);
    JointVector q = random_joints(*robot, generator);
    q[4] *= 1e-9;
    const Singularity found = robot->singularity(q);
    ASSERT_LT(found.manipulability, 1e-8);
    ASSERT_NE(found.name, "none");
  }
}

TEST(RobotModel, NamesTheElbowOfAPlanarArmAndHowNearItIs) {
  const RobotPtr robot = arm("two_link");
  EXPECT_EQ(robot->singularity(Eigen::Vector2d(0.3, 1e-4)).name, "elbow");
  EXPECT_NEAR(robot->singularity(Eigen::Vector2d(0.3, 1e-4)).distance, 1e-4, 1e-9);
  EXPECT_EQ(robot->singularity(Eigen::Vector2d(0.3, 1.2)).name, "none");
  EXPECT_NEAR(robot->singularity(Eigen::Vector2d(0.3, 1.2)).distance, 1.2, 1e-9);
}

TEST(RobotModel, CallsSevenJointsSingularOnlyWhereADirectionIsLost) {
  const RobotPtr robot = arm("iiwa14");
  JointVector q(7);
  q << 0.3, 0.0, 0.4, -1.2, 0.5, 0.9, 0.2;  // axes 1 and 3 in line: the others make up for it
  EXPECT_EQ(robot->singularity(q).name, "none");
  q << 0.3, 0.7, 0.4, 0.0, 0.5, 0.9, 0.2;  // stretched
  EXPECT_EQ(robot->singularity(q).name, "boundary");
  EXPECT_LT(robot->singularity(q).distance, 1e-9);
}

TEST(RobotModel, CallsAGeneralArmNearItsBoundary) {
  // A PUMA out of true by 0.1 mm has no closed form: its smallest singular value tells.
  RobotDescription description = load_description(VIAPOINT_TEST_ROBOTS "/puma560.yaml");
  description.chain[4].before.translation().x() += 1e-4;
  const RobotPtr robot = RobotModel::make(description);
  JointVector q(6);
  q << 0.3, -0.4, 0.5, 0.6, 1e-4, 0.2;
  EXPECT_EQ(robot->singularity(q).name, "boundary");
  q[4] = 1.0;
  EXPECT_EQ(robot->singularity(q).name, "none");
}

TEST(RobotModel, FingerprintFollowsWhatMovesAlike) {
  const RobotDescription puma = load_description(VIAPOINT_TEST_ROBOTS "/puma560.yaml");
  const std::string print = RobotModel::make(puma)->fingerprint();
  EXPECT_EQ(print.size(), 16u);
  RobotDescription other = puma;
  other.title = "another title";
  other.sources.clear();
  EXPECT_EQ(RobotModel::make(other)->fingerprint(), print);
  other = puma;
  other.tool.translation().x() += 1e-12;
  EXPECT_NE(RobotModel::make(other)->fingerprint(), print);
  other = puma;
  other.limits.jerk[5] *= 1.0 + 1e-15;
  EXPECT_NE(RobotModel::make(other)->fingerprint(), print);
  other = puma;
  other.chain[2].before.translation().y() += 1e-12;
  EXPECT_NE(RobotModel::make(other)->fingerprint(), print);
}

TEST(RobotModel, TakesOtherLimitsAfterChecking) {
  const RobotPtr robot = arm("puma560");
  JointLimits limits = robot->limits();
  limits.velocity *= 0.5;
  const RobotPtr slow = robot->with_limits(limits);
  EXPECT_EQ(slow->limits().velocity, limits.velocity);
  EXPECT_NE(slow->fingerprint(), robot->fingerprint());
  limits.velocity[2] = 0.0;
  EXPECT_THROW((void)robot->with_limits(limits), MotionError);
  EXPECT_THROW((void)robot->with_limits(arm("two_link")->limits()), MotionError);
}

TEST(RobotModel, JointRobotHasNoKinematics) {
  const JointLimits limits = arm("ur5e")->limits();
  const RobotPtr robot = RobotModel::joint_robot(limits);
  EXPECT_FALSE(robot->has_kinematics());
  EXPECT_EQ(robot->joints(), 6);
  try {
    (void)robot->fk(JointVector::Zero(6));
    FAIL() << "answered";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUncontrolled);
  }
}

TEST(RobotModel, RefusesAChainThatDoesNotFitItsLimits) {
  RobotDescription description = load_description(VIAPOINT_TEST_ROBOTS "/puma560.yaml");
  description.chain.pop_back();
  EXPECT_THROW((void)RobotModel::make(description), MotionError);
  description = load_description(VIAPOINT_TEST_ROBOTS "/puma560.yaml");
  description.chain[1].axis *= 2.0;
  EXPECT_THROW((void)RobotModel::make(description), MotionError);
}

}  // namespace
}  // namespace viapoint
