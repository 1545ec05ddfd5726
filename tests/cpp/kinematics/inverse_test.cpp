// Inverse kinematics over thousands of seeded poses of every built-in arm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinematics/arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

bool holds(const std::vector<JointVector>& solutions, const JointVector& q, double tolerance) {
  return std::any_of(solutions.begin(), solutions.end(), [&](const JointVector& solution) {
    return (solution - q).lpNorm<Eigen::Infinity>() < tolerance;
  });
}

void expect_pose(const RobotModel& robot, const JointVector& q, const Pose& pose) {
  ASSERT_TRUE(robot.limits().contains(q));
  const Pose reached = robot.fk(q);
  ASSERT_LT((reached.translation() - pose.translation()).norm(), 1.01e-9);
  ASSERT_LT(rotation_distance(reached.linear(), pose.linear()), 1.01e-9);
}

class EveryArmsInverse : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(InverseKinematics, EveryArmsInverse, testing::ValuesIn(kArms),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(EveryArmsInverse, SolvesReachablePosesWithinLimits) {
  const RobotPtr robot = arm(GetParam());
  std::mt19937_64 generator(11);
  for (int problem = 0; problem < 3000; ++problem) {
    SCOPED_TRACE(problem);
    const Pose pose = robot->fk(random_joints(*robot, generator));
    const JointVector near = random_joints(*robot, generator);
    JointVector q;
    ASSERT_NO_THROW(q = robot->inverse().solve_near(pose, near));
    ASSERT_NO_FATAL_FAILURE(expect_pose(*robot, q, pose));
  }
}

TEST_P(EveryArmsInverse, SolvesReachablePositionsWithinLimits) {
  const RobotPtr robot = arm(GetParam());
  std::mt19937_64 generator(12);
  for (int problem = 0; problem < 1000; ++problem) {
    SCOPED_TRACE(problem);
    const Eigen::Vector3d p = robot->fk(random_joints(*robot, generator)).translation();
    const JointVector near = random_joints(*robot, generator);
    JointVector q;
    ASSERT_NO_THROW(q = robot->inverse().solve_near(p, near));
    ASSERT_TRUE(robot->limits().contains(q));
    ASSERT_LT((robot->fk(q).translation() - p).norm(), 1.01e-9);
  }
}

TEST_P(EveryArmsInverse, StaysWhereItIsWhenThePoseIsThatOfNear) {
  const RobotPtr robot = arm(GetParam());
  std::mt19937_64 generator(13);
  for (int problem = 0; problem < 1000; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const JointVector found = robot->inverse().solve_near(robot->fk(q), q);
    // At a singular pose the joints are known to the root of the pose's rounding only.
    ASSERT_LT((found - q).lpNorm<Eigen::Infinity>(), 1e-6);
  }
}

TEST_P(EveryArmsInverse, GivesTheSameAnswerEveryTime) {
  std::mt19937_64 generator(14);
  const RobotPtr first = arm(GetParam());
  const RobotPtr second = arm(GetParam());
  for (int problem = 0; problem < 50; ++problem) {
    SCOPED_TRACE(problem);
    const Pose pose = first->fk(random_joints(*first, generator));
    const JointVector near = random_joints(*first, generator);
    ASSERT_EQ(first->inverse().solve_near(pose, near), second->inverse().solve_near(pose, near));
  }
}

TEST_P(EveryArmsInverse, LeavesTheLimitsAsideOnlyWhenAsked) {
  const RobotPtr robot = arm(GetParam());
  std::mt19937_64 generator(15);
  for (int problem = 0; problem < 300; ++problem) {
    SCOPED_TRACE(problem);
    JointVector q = random_joints(*robot, generator);
    for (int i = 0; i < robot->joints(); ++i) {
      if (robot->forward().type(i) == JointType::kRevolute) q[i] += 2.0 * kPi;
    }
    const Pose pose = robot->fk(q);
    const JointVector found = robot->inverse().solve_near_unlimited(pose, q);
    ASSERT_LT((found - q).lpNorm<Eigen::Infinity>(), 1e-6);
    ASSERT_LT(pose_distance(robot->fk(found), pose), 2e-9);
  }
}

TEST_P(EveryArmsInverse, RefusesWhatIsNotAPose) {
  const RobotPtr robot = arm(GetParam());
  const JointVector near = JointVector::Zero(robot->joints());
  Pose pose = robot->fk(near);
  pose.linear() *= 1.01;
  const auto code_of = [](const auto& call) {
    try {
      call();
    } catch (const MotionError& error) {
      return error.code();
    }
    return ErrorCode::kInternal;
  };
  EXPECT_EQ(code_of([&] { (void)robot->inverse().solve_near(pose, near); }),
            ErrorCode::kNotARotation);
  pose = robot->fk(near);
  pose.translation().x() = NAN;
  EXPECT_EQ(code_of([&] { (void)robot->inverse().solve_near(pose, near); }),
            ErrorCode::kBadArgument);
  EXPECT_EQ(code_of([&] { (void)robot->inverse().solve_all(pose); }), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of([&] {
              (void)robot->inverse().solve_near(robot->fk(near),
                                                JointVector::Zero(robot->joints() + 1));
            }),
            ErrorCode::kBadArgument);
}

TEST(InverseKinematics, SaysHowFarOutOfReach) {
  for (const char* name : {"puma560", "two_link", "scara", "ur5e", "panda"}) {
    const RobotPtr robot = arm(name);
    const JointVector near = 0.5 * (robot->limits().position_min + robot->limits().position_max);
    Pose pose = robot->fk(near);
    pose.translation().x() += 10.0;
    for (const bool position_only : {false, true}) {
      SCOPED_TRACE(testing::Message() << name << (position_only ? ", position" : ", pose"));
      try {
        if (position_only) {
          (void)robot->inverse().solve_near(Eigen::Vector3d(pose.translation()), near);
        } else {
          (void)robot->inverse().solve_near(pose, near);
        }
        FAIL() << "solved";
      } catch (const MotionError& error) {
        EXPECT_EQ(error.code(), ErrorCode::kUnreachable);
        ASSERT_TRUE(error.problem().value.has_value());
        EXPECT_GT(*error.problem().value, 5.0);
        EXPECT_LT(*error.problem().value, 12.0);
        EXPECT_FALSE(error.problem().ways_out.empty());
      }
    }
  }
}

TEST(InverseKinematics, ThePositionOutOfReachIsMeasured) {
  const RobotPtr robot = arm("two_link");  // stretched it is 3 m long
  try {
    (void)robot->inverse().solve_all(Eigen::Vector3d(3.0, 4.0, 0.0));
    FAIL() << "solved";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnreachable);
    EXPECT_NEAR(*error.problem().value, 2.0, 1e-6);
  }
}

TEST(InverseKinematics, FindsTheGeneratingJointsAmongTheBranches) {
  for (const char* name : {"puma560", "two_link", "rpp", "scara"}) {
    SCOPED_TRACE(name);
    const RobotPtr robot = arm(name);
    const int problems = robot->joints() == 6 ? 3000 : 500;  // the short arms are searched
    std::mt19937_64 generator(16);
    for (int problem = 0; problem < problems; ++problem) {
      SCOPED_TRACE(problem);
      const JointVector q = random_joints(*robot, generator);
      const Pose pose = robot->fk(q);
      const auto all = robot->inverse().solve_all(pose);
      ASSERT_TRUE(holds(all, q, 1e-6));
      for (const JointVector& solution : all) {
        ASSERT_NO_FATAL_FAILURE(expect_pose(*robot, solution, pose));
      }
      for (size_t i = 1; i < all.size(); ++i) {
        ASSERT_LE(all[i - 1].lpNorm<Eigen::Infinity>(), all[i].lpNorm<Eigen::Infinity>());
      }
    }
  }
}

TEST(InverseKinematics, FindsTheGeneratingJointsOfTheUr5e) {
  const RobotPtr robot = arm("ur5e");
  std::mt19937_64 generator(17);
  for (int problem = 0; problem < 200; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    ASSERT_TRUE(holds(robot->inverse().solve_all(robot->fk(q)), q, 1e-6));
  }
}

TEST(InverseKinematics, NearIsTheNearestOfAll) {
  for (const char* name : {"puma560", "two_link", "scara", "ur5e"}) {
    SCOPED_TRACE(name);
    const RobotPtr robot = arm(name);
    std::mt19937_64 generator(18);
    for (int problem = 0; problem < 200; ++problem) {
      SCOPED_TRACE(problem);
      const Pose pose = robot->fk(random_joints(*robot, generator));
      const JointVector near = 1.5 * random_joints(*robot, generator);
      const JointVector found = robot->inverse().solve_near(pose, near);
      double least = 1e300;
      for (const JointVector& q : robot->inverse().solve_all(pose)) {
        least = std::min(least, (q - near).lpNorm<Eigen::Infinity>());
      }
      ASSERT_NEAR((found - near).lpNorm<Eigen::Infinity>(), least, 1e-6);
    }
  }
}

TEST(InverseKinematics, TwoLinkHasTheTextbooksBranches) {
  // Textbook §5: (2, 2) is reached with the elbow on either side; (3, 0) only stretched.
  const RobotPtr robot = arm("two_link");
  const auto goal = robot->inverse().solve_all(Eigen::Vector3d(2.0, 2.0, 0.0));
  ASSERT_EQ(goal.size(), 2u);
  EXPECT_TRUE(holds(goal, Eigen::Vector2d(17.11443316390629, 41.409622109270856) * kDegree, 1e-9));
  EXPECT_TRUE(holds(goal, Eigen::Vector2d(72.88556683609372, -41.409622109270856) * kDegree, 1e-9));
  const auto start = robot->inverse().solve_all(Eigen::Vector3d(3.0, 0.0, 0.0));
  ASSERT_EQ(start.size(), 1u);
  EXPECT_LT(start[0].lpNorm<Eigen::Infinity>(), 1e-5);
}

TEST(InverseKinematics, RppReachesTheTextbooksPositions) {
  const RobotPtr robot = arm("rpp");
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0.0, 0.2, 0.5), Eigen::Vector3d(1.0, 1.2, 0.5)}) {
    const auto all = robot->inverse().solve_all(p);
    ASSERT_EQ(all.size(), 1u);
    // p = (−d3 sin θ1, d3 cos θ1, 0.5 + d2)
    EXPECT_NEAR(all[0][0], std::atan2(-p.x(), p.y()), 1e-9);
    EXPECT_NEAR(all[0][1], p.z() - 0.5, 1e-9);
    EXPECT_NEAR(all[0][2], std::hypot(p.x(), p.y()), 1e-9);
  }
}

TEST(InverseKinematics, ASlideTooShortIsALimitNotOutOfReach) {
  const RobotPtr robot = arm("rpp");
  try {
    (void)robot->inverse().solve_near(Eigen::Vector3d(0.0, 2.5, 0.5), Eigen::Vector3d(0, 0, 1));
    FAIL() << "solved";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutsideLimits);
    EXPECT_EQ(error.problem().joint, 2);
    EXPECT_NEAR(*error.problem().value, 2.5, 1e-9);
    EXPECT_EQ(error.problem().limit, 2.0);
  }
}

TEST(InverseKinematics, ScaraFollowsTheTextbooksFormula) {
  const RobotPtr robot = arm("scara");
  std::mt19937_64 generator(19);
  for (int problem = 0; problem < 1000; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const Pose pose = robot->fk(q);
    const double sum = q[0] - q[1];
    const Eigen::Vector3d expected(0.4 * std::cos(q[0]) + 0.3 * std::cos(sum),
                                   0.4 * std::sin(q[0]) + 0.3 * std::sin(sum), 0.5 - q[2] - 0.1);
    ASSERT_LT((pose.translation() - expected).norm(), 1e-14);
    ASSERT_LT((pose.linear().col(2) + Eigen::Vector3d::UnitZ()).norm(), 1e-14);
  }
}

TEST(InverseKinematics, AShortArmRefusesAPoseItCannotHold) {
  const RobotPtr robot = arm("two_link");
  const Eigen::Vector2d q(0.3, 0.9);
  Pose pose = robot->fk(q);
  EXPECT_LT((robot->inverse().solve_near(pose, q) - q).lpNorm<Eigen::Infinity>(), 1e-9);
  pose.linear() = pose.linear() * rotation_exp(Eigen::Vector3d(0.0, 0.0, 0.5));
  try {
    (void)robot->inverse().solve_near(pose, q);
    FAIL() << "solved";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUncontrolled);
    EXPECT_NE(error.problem().message.find("x, y, turn about z"), std::string::npos);
    EXPECT_FALSE(error.problem().ways_out.empty());
  }
  EXPECT_NO_THROW((void)robot->inverse().solve_near(Eigen::Vector3d(pose.translation()), q));
}

TEST(InverseKinematics, SaysWhichFamilySolves) {
  EXPECT_NE(arm("puma560")->inverse().family().find("spherical wrist"), std::string::npos);
  EXPECT_NE(arm("ur5e")->inverse().family().find("three parallel axes"), std::string::npos);
  EXPECT_NE(arm("iiwa14")->inverse().family().find("arm angle"), std::string::npos);
  EXPECT_NE(arm("scara")->inverse().family().find("RRPR"), std::string::npos);
  EXPECT_NE(arm("panda")->inverse().family().find("joint 7 as the parameter"), std::string::npos);
}

}  // namespace
}  // namespace viapoint
