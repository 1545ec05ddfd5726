// Arms out of true, as a calibration finds them: every branch of the nearest true arm's closed form
// leads to one of the arm as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinematics/arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

/// Every link turned by up to `angle` [rad] and moved by up to `length` [m].
RobotPtr out_of_true(const std::string& name, double angle, double length, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  RobotDescription description =
      load_description(std::string(VIAPOINT_TEST_ROBOTS) + "/" + name + ".yaml");
  for (ChainJoint& joint : description.chain) {
    const auto some = [&] {
      return Eigen::Vector3d(unit(generator), unit(generator), unit(generator));
    };
    joint.before.linear() = joint.before.linear() * rotation_exp(angle / 2.0 * some());
    joint.before.translation() += length / 2.0 * some();
  }
  return RobotModel::make(description);
}

TEST(NearlyClosedForms, FindTheJointsThatMadeThePose) {
  for (const char* name : {"puma560", "ur5e"}) {
    for (const double size : {1e-6, 1e-4, 2e-3}) {
      const RobotPtr robot = out_of_true(name, size, size, 5);
      ASSERT_NE(robot->inverse().family().find("out of true"), std::string::npos)
          << robot->inverse().family();
      std::mt19937_64 generator(111);
      for (int problem = 0; problem < 1000; ++problem) {
        SCOPED_TRACE(testing::Message() << name << " " << size << " seed 111 problem " << problem);
        const JointVector q = random_joints(*robot, generator);
        const Pose pose = robot->fk(q);
        const JointVector found = robot->inverse().solve_near(pose, q);
        ASSERT_LT(pose_distance(robot->fk(found), pose), 2e-9);
        ASSERT_TRUE(robot->limits().contains(found));
        ASSERT_LT((found - q).lpNorm<Eigen::Infinity>(), 1e-5);
      }
    }
  }
}

TEST(NearlyClosedForms, GiveExactDistinctBranchesWithTheJointsThatMadeThePose) {
  const RobotPtr robot = out_of_true("ur5e", 1e-3, 1e-3, 6);
  std::mt19937_64 generator(112);
  int most = 0;
  for (int problem = 0; problem < 1000; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const Pose pose = robot->fk(q);
    BranchSet branches;
    ASSERT_EQ(robot->inverse().solve_branches(pose, q, branches), BranchStatus::kSolved);
    most = std::max(most, branches.size());
    bool again = false;
    for (int i = 0; i < branches.size(); ++i) {
      ASSERT_LT(pose_distance(robot->fk(branches[i]), pose), 2e-9);
      ASSERT_TRUE(robot->limits().contains(branches[i]));
      again = again || (branches[i] - q).lpNorm<Eigen::Infinity>() < 1e-5;
      for (int k = 0; k < i; ++k) {
        ASSERT_GT((branches[i] - branches[k]).lpNorm<Eigen::Infinity>(), 1e-6);
      }
    }
    ASSERT_TRUE(again);
  }
  EXPECT_EQ(most, 8);
}

TEST(NearlyClosedForms, PutTheNearestOfAllSolutionsFirst) {
  const RobotPtr robot = out_of_true("puma560", 1e-3, 1e-3, 7);
  std::mt19937_64 generator(113);
  for (int problem = 0; problem < 50; ++problem) {
    SCOPED_TRACE(problem);
    JointVector q = 0.7 * random_joints(*robot, generator);
    q[4] = 0.6;
    q[2] = 0.4;  // clear of the wrist's and the elbow's singularity
    const auto all = robot->inverse().solve_all(robot->fk(q), q);
    ASSERT_LT((all.front() - q).lpNorm<Eigen::Infinity>(), 1e-6);
    for (const JointVector& each : all) {
      ASSERT_LT(pose_distance(robot->fk(each), robot->fk(q)), 2e-9);
    }
  }
}

TEST(NearlyClosedForms, FollowAPathThroughTheWristSingularity) {
  const RobotPtr robot = out_of_true("ur5e", 1e-4, 1e-4, 8);
  std::mt19937_64 generator(114);
  for (int path = 0; path < 20; ++path) {
    SCOPED_TRACE(path);
    JointVector start = 0.4 * random_joints(*robot, generator);
    start[2] = 1.0;
    start[4] = -0.3;
    JointVector end = start;
    end[4] = 0.3;
    JointVector q = start;
    for (int step = 1; step <= 100; ++step) {
      const JointVector goal = start + (end - start) * (step / 100.0);
      ASSERT_NO_THROW(q = robot->inverse().solve_near(robot->fk(goal), q)) << "step " << step;
      ASSERT_LT(pose_distance(robot->fk(q), robot->fk(goal)), 2e-9);
    }
  }
}

TEST(NearlyClosedForms, RefuseWhatIsOutOfReach) {
  const RobotPtr robot = out_of_true("ur5e", 1e-3, 1e-3, 9);
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(2.0, 0.0, 0.5);
  try {
    (void)robot->inverse().solve_near(pose, JointVector::Zero(6));
    FAIL() << "solved";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnreachable);
    EXPECT_GT(*error.problem().value, 0.5);
  }
}

}  // namespace
}  // namespace viapoint
