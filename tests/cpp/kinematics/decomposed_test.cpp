// Arms that come apart into placing and turning: recognised, every branch found, named, measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinematics/arms.hpp"
#include "kinematics/dh_arm.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

constexpr double kRight = kPi / 2.0;
constexpr JointType kSlide = JointType::kPrismatic;

struct Sample {
  const char* name;
  RobotPtr robot;
  size_t most_branches;  ///< of a pose within the limits: slides are not negative
};

Pose tool_at(double x, double y, double z) {
  Pose tool = Pose::Identity();
  tool.translation() = Eigen::Vector3d(x, y, z);
  tool.linear() = rotation_exp(Eigen::Vector3d(0.3, -0.2, 0.4));
  return tool;
}

/// One of each kind: rows of d, a, alpha.
std::vector<Sample> samples() {
  const Pose tool = tool_at(0.05, -0.1, 0.2);
  return {
      {"2R", dh_arm("2R", {{0, 0.5, 0}, {0, 0.4, 0}}), 1},
      {"3R", dh_arm("3R", {{0, 0.5, 0}, {0, 0.4, 0}, {0, 0.2, 0}}), 2},
      {"PPP",
       dh_arm("PPP",
              {{0, 0, -kRight, kSlide}, {0, 0, kRight, kSlide, kRight}, {0, 0.1, 0, kSlide}}),
       1},
      {"skew PPP",
       dh_arm("skew PPP", {{0, 0, -1.2, kSlide}, {0, 0.1, 0.9, kSlide, 0.8}, {0, 0.1, 0.4, kSlide}},
              tool),
       1},
      {"RPP", dh_arm("RPP", {{0.5, 0, 0}, {0, 0, -kRight, kSlide}, {0.2, 0, 0, kSlide}}), 1},
      {"RPP with offsets",
       dh_arm("RPP with offsets", {{0.5, 0.1, 0}, {0, 0.05, -kRight, kSlide}, {0, 0, 0, kSlide}},
              tool),
       1},
      {"RRP", dh_arm("RRP", {{0.4, 0, -kRight}, {0.1, 0, kRight}, {0.2, 0, 0, kSlide}}), 1},
      {"PRP", dh_arm("PRP", {{0, 0.1, 0, kSlide}, {0, 0, -kRight}, {0.2, 0, 0, kSlide}}), 1},
      {"RPR", dh_arm("RPR", {{0.3, 0.4, 0}, {0, 0, 0, kSlide}, {0, 0.3, 0}}), 1},
      {"SCARA RRPR",
       dh_arm("RRPR", {{0.5, 0.4, 0}, {0, 0.3, kPi}, {0, 0, 0, kSlide}, {0.1, 0, 0}}, tool), 2},
      {"SCARA PRRR", dh_arm("PRRR", {{0, 0, 0, kSlide}, {0, 0.4, 0}, {0, 0.3, 0}, {0, 0, 0}}, tool),
       2},
      {"SCARA RRRP", dh_arm("RRRP", {{0.3, 0.4, 0}, {0, 0.3, 0}, {0, 0, kPi}, {0, 0, 0, kSlide}}),
       2},
      {"palletiser RRRR",
       dh_arm("RRRR", {{0.4, 0.1, -kRight}, {0, 0.5, 0}, {0, 0.4, 0}, {0, 0.1, 0}}, tool), 2},
      {"five axes",
       dh_arm("5R", {{0.4, 0.1, -kRight}, {0, 0.5, 0}, {0, 0.4, 0}, {0, 0, -kRight}, {0.1, 0, 0}},
              tool),
       4},
      {"gantry with a wrist",
       dh_arm("PPPRRR",
              {{0, 0, -kRight, kSlide},
               {0, 0, kRight, kSlide, kRight},
               {0, 0, 0, kSlide},
               {0, 0, -kRight},
               {0, 0, kRight},
               {0.1, 0, 0}},
              tool),
       2},
      {"cylinder with a wrist",
       dh_arm("RPPRRR",
              {{0.5, 0, 2},
               {0, 0, -kRight, kSlide},
               {0.2, 0, 0, kSlide},
               {0, 0, -kRight},
               {0, 0, kRight},
               {0.1, 0, 0}},
              tool),
       2},
      {"polar with a wrist (Stanford)",
       dh_arm("RRPRRR",
              {{0.4, 0, -kRight},
               {0.15, 0, kRight},
               {0.2, 0, 0, kSlide},
               {0, 0, -kRight},
               {0, 0, kRight},
               {0.2, 0, 0}},
              tool),
       4},
      {"oblique wrist",
       dh_arm("6R oblique",
              {{0.5, 0.15, -kRight},
               {0, 0.6, 0},
               {0, 0.1, -kRight},
               {0.6, 0, 1.0},
               {0, 0, -1.0},
               {0.1, 0, 0}},
              tool),
       8},
      {"oblique shoulder",
       dh_arm("6R shoulder",
              {{0.5, 0, -1.1},
               {0, 0, 1.2},
               {0.4, 0.1, -kRight},
               {0, 0.4, 0},
               {0, 0.1, -kRight},
               {0.1, 0, 0}},
              tool),
       8},
  };
}

bool same_pose(const RobotModel& robot, const JointVector& q, const Pose& pose) {
  const Pose reached = robot.fk(q);
  return (reached.translation() - pose.translation()).norm() < 1.01e-9 &&
         rotation_distance(reached.linear(), pose.linear()) < 1.01e-9;
}

TEST(DecomposedArm, FindsTheGeneratingJointsAmongDistinctBranches) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const RobotModel& robot = *sample.robot;
    ASSERT_NE(robot.inverse().family().find("closed form"), std::string::npos)
        << robot.inverse().family();
    std::mt19937_64 generator(71);
    size_t most = 0;
    for (int problem = 0; problem < 1000; ++problem) {
      SCOPED_TRACE(problem);
      const JointVector q = random_joints(robot, generator);
      const Pose pose = robot.fk(q);
      const auto all = robot.inverse().solve_all(pose);
      bool found = false;
      for (size_t i = 0; i < all.size(); ++i) {
        ASSERT_TRUE(robot.limits().contains(all[i]));
        ASSERT_TRUE(same_pose(robot, all[i], pose));
        found = found || (all[i] - q).lpNorm<Eigen::Infinity>() < 1e-6;
        for (size_t k = 0; k < i; ++k) {
          ASSERT_GT((all[i] - all[k]).lpNorm<Eigen::Infinity>(), 1e-9);
        }
      }
      ASSERT_TRUE(found);
      most = std::max(most, all.size());
    }
    EXPECT_EQ(most, sample.most_branches) << robot.inverse().family();
  }
}

TEST(DecomposedArm, EachBranchHasAConfigurationOfItsOwnThatFindsItAgain) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const RobotModel& robot = *sample.robot;
    std::mt19937_64 generator(72);
    for (int problem = 0; problem < 200; ++problem) {
      SCOPED_TRACE(problem);
      const JointVector q = random_joints(robot, generator);
      const auto found = robot.inverse().solve_all(robot.fk(q), JointVector::Zero(robot.joints()),
                                                   robot.inverse().configuration(q));
      ASSERT_EQ(found.size(), 1u);
      ASSERT_LT((found[0] - q).lpNorm<Eigen::Infinity>(), 1e-6);
    }
  }
}

TEST(DecomposedArm, SolvesSingularPoses) {
  // Every joint in turn near a right angle, and all of them on the grid.
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const RobotModel& robot = *sample.robot;
    std::mt19937_64 generator(73);
    for (const double offset : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4, 1e-3}) {
      for (int joint = 0; joint <= robot.joints(); ++joint) {
        for (int problem = 0; problem < 10; ++problem) {
          SCOPED_TRACE(testing::Message() << offset << " joint " << joint << " " << problem);
          JointVector q = random_joints(robot, generator);
          for (int i = 0; i < robot.joints(); ++i) {
            if (robot.forward().type(i) != JointType::kRevolute) continue;
            if (i != joint && joint != robot.joints()) continue;
            q[i] = std::clamp(std::round(q[i] / kRight), -1.0, 1.0) * kRight + offset;
          }
          const Pose pose = robot.fk(q);
          JointVector found;
          ASSERT_NO_THROW(found = robot.inverse().solve_near(pose, q)) << q.transpose();
          ASSERT_TRUE(robot.limits().contains(found));
          ASSERT_TRUE(same_pose(robot, found, pose));
        }
      }
    }
  }
}

TEST(DecomposedArm, MeasuresHowFarAPoseIsOutOfReach) {
  // A point beyond the stretched arm by 1 µm to 1 m, in the direction in which it is stretched.
  for (const char* name : {"two_link", "scara"}) {
    SCOPED_TRACE(name);
    const RobotPtr robot = arm(name);
    std::mt19937_64 generator(74);
    for (const double beyond : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
      for (int problem = 0; problem < 100; ++problem) {
        SCOPED_TRACE(testing::Message() << beyond << " problem " << problem);
        JointVector q = random_joints(*robot, generator);
        q[1] = 0.0;
        Pose pose = robot->fk(q);
        const Eigen::Vector3d outwards(pose.translation().x(), pose.translation().y(), 0.0);
        pose.translation() += beyond * outwards.normalized();
        for (const bool position_only : {false, true}) {
          try {
            if (position_only) {
              (void)robot->inverse().solve_all(Eigen::Vector3d(pose.translation()));
            } else {
              (void)robot->inverse().solve_all(pose);
            }
            FAIL() << "solved";
          } catch (const MotionError& error) {
            ASSERT_EQ(error.code(), ErrorCode::kUnreachable);
            ASSERT_NEAR(*error.problem().value, beyond, 1e-9);
          }
        }
      }
    }
  }
}

TEST(DecomposedArm, ScaraHasALeftAndARightElbow) {
  const RobotPtr robot = arm("scara");
  const JointVector q = Eigen::Vector4d(0.2, 0.9, 0.1, 0.3);
  const auto all = robot->inverse().solve_all(robot->fk(q));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(robot->inverse().configuration(all[0]).elbow,
            -robot->inverse().configuration(all[1]).elbow);
  EXPECT_EQ(robot->inverse().configuration(all[0]).shoulder, 0);
  EXPECT_NEAR(all[0][1], -all[1][1], 1e-12);
}

TEST(DecomposedArm, ThePlanarArmsElbowIsUpWhenItTurnsClockwise) {
  const RobotPtr robot = arm("two_link");
  EXPECT_EQ(robot->inverse().configuration(Eigen::Vector2d(0.4, 0.7)).elbow, -1);
  EXPECT_EQ(robot->inverse().configuration(Eigen::Vector2d(0.4, -0.7)).elbow, 1);
  EXPECT_EQ(robot->inverse().configuration(Eigen::Vector2d(0.4, 0.0)).elbow, 0);
  // Its axes 2 to 4 point down.
  const RobotPtr scara = arm("scara");
  EXPECT_EQ(scara->inverse().configuration(Eigen::Vector4d(0.2, 0.9, 0.1, 0.3)).elbow, 1);
}

TEST(DecomposedArm, NamesSidesAsTheSphericalWristDoes) {
  // A PUMA whose wrist is a hair from square is solved by decomposition, and stands alike.
  RobotDescription description = load_description(VIAPOINT_TEST_ROBOTS "/puma560.yaml");
  description.chain[4].before.linear() =
      description.chain[4].before.linear() * rotation_exp(Eigen::Vector3d(1e-6, 0.0, 0.0));
  const RobotPtr robot = RobotModel::make(description);
  ASSERT_NE(robot->inverse().family().find("RRRRRR"), std::string::npos)
      << robot->inverse().family();
  const RobotPtr puma = arm("puma560");
  std::mt19937_64 generator(75);
  for (int problem = 0; problem < 500; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const Configuration here = robot->inverse().configuration(q);
    const Configuration there = puma->inverse().configuration(q);
    if (puma->singularity(q).distance < 1e-3) continue;
    ASSERT_TRUE(here.fits(there)) << here.describe() << " and " << there.describe();
  }
}

TEST(DecomposedArm, AChainThatDoesNotComeApartIsSolvedBySearch) {
  const RobotPtr robot = dh_arm("6R", {{0.3, 0.1, 1.0},
                                       {0.1, 0.4, 0.7},
                                       {0.2, 0.3, -0.8},
                                       {0.1, 0.2, 0.9},
                                       {0.2, 0.1, -1.1},
                                       {0.1, 0.05, 0.3}});
  EXPECT_NE(robot->inverse().family().find("numerical"), std::string::npos);
}

}  // namespace
}  // namespace viapoint
