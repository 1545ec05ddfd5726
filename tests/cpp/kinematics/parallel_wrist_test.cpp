// The closed form for three parallel axes: singular sets, crossings, arms with every offset.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinematics/arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

TEST(ParallelWrist, HasTheMakersZeroPose) {
  // At zero the UR5e lies along −x with the flange facing −y: d4 + d6 aside, d1 − d5 up.
  const Pose pose = arm("ur5e")->fk(JointVector::Zero(6));
  EXPECT_LT((pose.translation() - Eigen::Vector3d(-0.8172, -0.2329, 0.0628)).norm(), 1e-12);
  EXPECT_LT((pose.linear().col(2) + Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(ParallelWrist, FindsEightBranches) {
  JointVector q(6);
  q << 0.3, -1.2, 1.4, -0.9, 1.1, 0.4;
  const RobotPtr robot = arm("ur5e");
  JointLimits limits = robot->limits();
  limits.position_min.setConstant(-kPi);
  limits.position_max.setConstant(kPi);
  EXPECT_EQ(robot->with_limits(limits)->inverse().solve_all(robot->fk(q)).size(), 8u);
}

TEST(ParallelWrist, SolvesSingularPoses) {
  const RobotPtr robot = arm("ur5e");
  std::mt19937_64 generator(51);
  for (const double offset : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, -1e-6, 1e-3}) {
    for (int set = 0; set < 4; ++set) {
      for (int problem = 0; problem < 300; ++problem) {
        SCOPED_TRACE(testing::Message()
                     << "offset " << offset << " set " << set << " problem " << problem);
        JointVector q = random_joints(*robot, generator);
        if (set == 0) q[4] = offset;
        if (set == 1) q[4] = kPi + offset;
        if (set == 2) q[2] = offset;
        if (set == 3) {
          for (int i = 0; i < 6; ++i) {
            q[i] = std::round(q[i] / (kPi / 2.0)) * (kPi / 2.0);
            if (i % 2 == 0) q[i] = std::clamp(q[i] + offset, -2.0 * kPi, 2.0 * kPi);
          }
        }
        const Pose pose = robot->fk(q);
        JointVector found;
        ASSERT_NO_THROW(found = robot->inverse().solve_near(pose, q));
        ASSERT_TRUE(robot->limits().contains(found));
        ASSERT_LT(pose_distance(robot->fk(found), pose), 2e-9);
      }
    }
  }
}

TEST(ParallelWrist, AtTheWristSingularityAnyNearIsServed) {
  // Joint 6 held where `near` has it may leave axis 4 out of reach: another value must be found.
  const RobotPtr robot = arm("ur5e");
  std::mt19937_64 generator(52);
  for (int problem = 0; problem < 1000; ++problem) {
    SCOPED_TRACE(problem);
    JointVector q = random_joints(*robot, generator);
    q[4] = problem % 2 == 0 ? 0.0 : kPi;
    const Pose pose = robot->fk(q);
    const JointVector near = random_joints(*robot, generator);
    JointVector found;
    ASSERT_NO_THROW(found = robot->inverse().solve_near(pose, near));
    ASSERT_TRUE(robot->limits().contains(found));
    ASSERT_LT(pose_distance(robot->fk(found), pose), 2e-9);
  }
}

TEST(ParallelWrist, NamesItsSingularities) {
  const RobotPtr robot = arm("ur5e");
  JointVector q(6);
  q << 0.1, -1.0, 1.2, 0.3, 0.01, 0.5;
  EXPECT_EQ(robot->singularity(q).name, "wrist");
  EXPECT_NEAR(robot->singularity(q).distance, 0.01, 1e-12);
  q << 0.1, -1.0, 0.02, 0.3, 1.0, 0.5;
  EXPECT_EQ(robot->singularity(q).name, "elbow");
  EXPECT_NEAR(robot->singularity(q).distance, 0.02, 1e-12);
  q << 0.1, -1.0, 1.2, 0.3, 1.0, 0.5;
  EXPECT_EQ(robot->singularity(q).name, "none");
  bool shoulder_found = false;
  for (double q2 = -kPi; q2 < kPi; q2 += 1e-3) {
    q[1] = q2;
    const Singularity found = robot->singularity(q);
    if (found.distance > 1e-3) continue;
    shoulder_found = true;
    EXPECT_EQ(found.name, "shoulder");
    EXPECT_LT(found.manipulability, 1e-3);
  }
  EXPECT_TRUE(shoulder_found);
}

TEST(ParallelWrist, MeasuresHowFarItIsOutOfReach) {
  const RobotPtr robot = arm("ur5e");
  Pose pose = Pose::Identity();  // flange up at 0.1 m from axis 1: nearer than d4 = 0.1333 m
  pose.translation() = Eigen::Vector3d(0.1, 0.0, 0.5);
  try {
    (void)robot->inverse().solve_all(pose);
    FAIL() << "solved";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnreachable);
    EXPECT_NEAR(*error.problem().value, 0.0333, 1e-9);
  }
}

}  // namespace
}  // namespace viapoint
