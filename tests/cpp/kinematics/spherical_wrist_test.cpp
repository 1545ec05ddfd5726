// The closed form for spherical wrists: golden poses, singular sets, limits, turns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "golden.hpp"
#include "kinematics/arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

JointVector joints_of(const nlohmann::json& degrees) {
  JointVector q(static_cast<Eigen::Index>(degrees.size()));
  for (size_t i = 0; i < degrees.size(); ++i) {
    q[static_cast<Eigen::Index>(i)] = degrees[i].get<double>() * kDegree;
  }
  return q;
}

/// The PUMA under other limits.
RobotPtr puma(double low_degrees, double high_degrees) {
  const RobotPtr robot = arm("puma560");
  JointLimits limits = robot->limits();
  limits.position_min.setConstant(low_degrees * kDegree);
  limits.position_max.setConstant(high_degrees * kDegree);
  return robot->with_limits(limits);
}

TEST(SphericalWrist, ForwardKinematicsOfThePrintedJointsIsGolden) {
  // Textbook §3.
  const RobotPtr robot = arm("puma560");
  const auto data = golden("puma560");
  for (const char* point : {"A", "B", "C"}) {
    SCOPED_TRACE(point);
    const JointVector q = joints_of(data["joints_deg"][point]);
    const Pose expected = golden_pose(data["fk_of_joints"][point]);
    EXPECT_LT(pose_distance(robot->fk(q), expected), 1e-9);
    EXPECT_LT(pose_distance(robot->forward().pose(q), expected), 1e-9);
  }
}

TEST(SphericalWrist, FindsThePrintedJointsAgain) {
  // Textbook §3.
  const RobotPtr robot = arm("puma560");
  const auto data = golden("puma560");
  for (const char* point : {"A", "B", "C"}) {
    SCOPED_TRACE(point);
    const JointVector q = joints_of(data["joints_deg"][point]);
    const Pose pose = golden_pose(data["fk_of_joints"][point]);
    double nearest = 1e300;
    for (const JointVector& solution : robot->inverse().solve_all(pose)) {
      nearest = std::min(nearest, (solution - q).lpNorm<Eigen::Infinity>());
    }
    EXPECT_LT(nearest, 1e-6);
    EXPECT_LT((robot->inverse().solve_near(pose, q) - q).lpNorm<Eigen::Infinity>(), 1e-6);
  }
}

TEST(SphericalWrist, LimitsOfThePumaAreGolden) {
  const JointVector limits = joints_of(golden("puma560")["limits_deg"]);
  const RobotPtr robot = arm("puma560");
  EXPECT_LT((robot->limits().position_max - limits).lpNorm<Eigen::Infinity>(), 1e-15);
  EXPECT_LT((robot->limits().position_min + limits).lpNorm<Eigen::Infinity>(), 1e-15);
}

TEST(SphericalWrist, TheRoundedPoseBNeedsSomewhatOtherJoints) {
  // Textbook §3: the projected B differs from the printed joints by 0.85° in joints 4 and 6.
  const RobotPtr robot = arm("puma560");
  const auto data = golden("puma560");
  const JointVector printed = joints_of(data["joints_deg"]["B"]);
  const Pose b = checked_pose(golden_pose(data["poses_m"]["B"]).matrix()).pose;
  const JointVector q = robot->inverse().solve_near(b, printed);
  const JointVector change = (q - printed).cwiseAbs() / kDegree;
  EXPECT_NEAR(std::max(change[3], change[5]), 0.85, 0.05);
}

TEST(SphericalWrist, SolvesSingularPoses) {
  // Sets around each singularity, and the grid of right angles where several meet.
  const RobotPtr robot = puma(-190.0, 190.0);
  std::mt19937_64 generator(21);
  const double stretched = std::atan2(-0.02, 0.433);  // elbow in line, up to half a turn
  for (const double offset : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, -1e-6, 1e-3}) {
    for (int set = 0; set < 5; ++set) {
      for (int problem = 0; problem < 300; ++problem) {
        SCOPED_TRACE(testing::Message()
                     << "offset " << offset << " set " << set << " problem " << problem);
        JointVector q = random_joints(*robot, generator);
        if (set == 0) q[4] = offset;
        if (set == 1) q[4] = kPi + offset;
        if (set == 2) q[2] = -kPi / 2.0 - stretched + offset;
        if (set == 3) q[2] = kPi / 2.0 - stretched + offset;
        if (set == 4) {
          for (int i = 0; i < 6; ++i) {
            q[i] = std::round(q[i] / (kPi / 2.0)) * (kPi / 2.0) + (i % 2 == 0 ? offset : 0.0);
          }
        }
        const Pose pose = robot->fk(q);
        JointVector found;
        ASSERT_NO_THROW(found = robot->inverse().solve_near(pose, q));
        ASSERT_TRUE(robot->limits().contains(found));
        const Pose reached = robot->fk(found);
        ASSERT_LT((reached.translation() - pose.translation()).norm(), 1.01e-9);
        ASSERT_LT(rotation_distance(reached.linear(), pose.linear()), 1.01e-9);
        ASSERT_NO_THROW((void)robot->inverse().solve_all(pose));
      }
    }
  }
}

TEST(SphericalWrist, SolvesWithTheWristAboveTheShoulder) {
  // Shoulder singularity: the wrist centre in the plane of axis 1 and axis 2's direction.
  const RobotPtr robot = arm("puma560");
  std::mt19937_64 generator(22);
  int met = 0;
  for (int problem = 0; problem < 2000; ++problem) {
    SCOPED_TRACE(problem);
    JointVector q = random_joints(*robot, generator);
    // In front of axis 1: 0.432 c2 + 0.433 s23 − 0.02 c23 = 0, solved for q2.
    const double c = 0.432 + 0.433 * std::sin(q[2]) - 0.02 * std::cos(q[2]);
    const double s = 0.433 * std::cos(q[2]) + 0.02 * std::sin(q[2]);
    q[1] = std::atan2(-c, s);
    if (!robot->limits().contains(q)) continue;
    ++met;
    ASSERT_LT(robot->singularity(q).distance, 1e-9);
    const Pose pose = robot->fk(q);
    JointVector found;
    ASSERT_NO_THROW(found = robot->inverse().solve_near(pose, q));
    ASSERT_LT(pose_distance(robot->fk(found), pose), 2e-9);
  }
  EXPECT_GT(met, 500);
}

TEST(SphericalWrist, KeepsJoint4AtTheWristSingularity) {
  const RobotPtr robot = arm("puma560");
  std::mt19937_64 generator(23);
  for (int problem = 0; problem < 2000; ++problem) {
    SCOPED_TRACE(problem);
    JointVector q = random_joints(*robot, generator);
    q[4] = 0.0;
    const JointVector found = robot->inverse().solve_near(robot->fk(q), q);
    ASSERT_EQ(found[3], q[3]);
    ASSERT_LT((found - q).lpNorm<Eigen::Infinity>(), 1e-6);
  }
}

TEST(SphericalWrist, SharesTheTurnOutWhenJoint4CannotKeepItsPlace) {
  // Joints 4 and 6 allow ±100°: a turn of 180° in all takes both, and neither may leave its limits.
  const RobotPtr robot = puma(-100.0, 100.0);
  std::mt19937_64 generator(24);
  for (int problem = 0; problem < 2000; ++problem) {
    SCOPED_TRACE(problem);
    JointVector q = random_joints(*robot, generator);
    q[4] = 0.0;
    const JointVector near = random_joints(*robot, generator);
    const Pose pose = robot->fk(q);
    JointVector found;
    ASSERT_NO_THROW(found = robot->inverse().solve_near(pose, near));
    ASSERT_TRUE(robot->limits().contains(found));
    ASSERT_LT(pose_distance(robot->fk(found), pose), 2e-9);
  }
}

TEST(SphericalWrist, FindsEveryWholeTurn) {
  const RobotPtr robot = arm("puma560");
  JointVector q(6);
  q << 0.3, -0.4, 0.5, 0.6, 0.7, 150.0 * kDegree;  // joint 6 allows ±260°: −210° does as well
  int turns = 0;
  for (const JointVector& solution : robot->inverse().solve_all(robot->fk(q))) {
    if ((solution - q).head<5>().lpNorm<Eigen::Infinity>() > 1e-6) continue;
    ++turns;
    EXPECT_NEAR(std::abs(std::remainder(solution[5] - q[5], 2.0 * kPi)), 0.0, 1e-9);
  }
  EXPECT_EQ(turns, 2);
}

TEST(SphericalWrist, TakesTheWholeTurnNearestToNear) {
  const RobotPtr robot = arm("puma560");
  JointVector q(6);
  q << 0.3, -0.4, 0.5, 0.6, 0.7, 150.0 * kDegree;
  JointVector near = q;
  near[5] = -250.0 * kDegree;
  EXPECT_NEAR(robot->inverse().solve_near(robot->fk(q), near)[5], -210.0 * kDegree, 1e-9);
  near[5] = -2000.0 * kDegree;  // far outside the limits: the nearest turn within them
  EXPECT_NEAR(robot->inverse().solve_near(robot->fk(q), near)[5], -210.0 * kDegree, 1e-9);
}

TEST(SphericalWrist, KeepsCoupledLimits) {
  JointLimits limits = arm("puma560")->limits();
  limits.coupling.resize(1, 6);
  limits.coupling << 0, 1, 1, 0, 0, 0;
  limits.coupling_lower = CouplingVector::Constant(1, -0.5);
  limits.coupling_upper = CouplingVector::Constant(1, 0.5);
  const RobotPtr robot = arm("puma560")->with_limits(limits);
  std::mt19937_64 generator(26);
  int inside = 0;
  int refused = 0;
  for (int problem = 0; problem < 3000; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const Pose pose = robot->fk(q);
    const bool allowed = limits.contains(q);
    try {
      for (const JointVector& solution : robot->inverse().solve_all(pose)) {
        ASSERT_TRUE(limits.contains(solution, 1e-12));
      }
      ASSERT_TRUE(limits.contains(robot->inverse().solve_near(pose, q), 1e-12));
      ++inside;
    } catch (const MotionError& error) {
      ASSERT_FALSE(allowed);
      ASSERT_EQ(error.code(), ErrorCode::kOutsideLimits);
      ++refused;
    }
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(refused, 300);
}

TEST(SphericalWrist, NamesTheJointAndLimitWhenReachableOnlyOutside) {
  const RobotPtr wide = puma(-179.0, 179.0);
  const RobotPtr robot = arm("puma560");
  std::mt19937_64 generator(27);
  int refused = 0;
  for (int problem = 0; problem < 3000; ++problem) {
    SCOPED_TRACE(problem);
    const Pose pose = robot->fk(random_joints(*wide, generator));
    try {
      ASSERT_TRUE(
          robot->limits().contains(robot->inverse().solve_near(pose, JointVector::Zero(6))));
    } catch (const MotionError& error) {
      ++refused;
      ASSERT_EQ(error.code(), ErrorCode::kOutsideLimits);
      const Problem& problem_found = error.problem();
      ASSERT_TRUE(problem_found.joint && problem_found.value && problem_found.limit);
      const int joint = *problem_found.joint;
      ASSERT_GT(std::abs(*problem_found.value), std::abs(*problem_found.limit));
      ASSERT_TRUE(*problem_found.limit == robot->limits().position_min[joint] ||
                  *problem_found.limit == robot->limits().position_max[joint]);
      ASSERT_NE(error.problem().message.find("joint " + std::to_string(joint + 1)),
                std::string::npos);
    }
  }
  EXPECT_GT(refused, 300);
}

TEST(SphericalWrist, MeasuresHowFarTheWristIsOutOfReach) {
  const RobotPtr robot = arm("puma560");
  const double reach = 0.432 + std::hypot(0.433, 0.02);
  Pose pose = Pose::Identity();
  // The wrist centre is the tool point: straight up, at the reach of the planar arm and 0.1 m more.
  pose.translation() = Eigen::Vector3d(0.149, 0.0, reach + 0.1);
  try {
    (void)robot->inverse().solve_all(pose);
    FAIL() << "solved";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnreachable);
    EXPECT_NEAR(*error.problem().value, 0.1, 1e-9);
  }
  pose.translation() = Eigen::Vector3d(0.1, 0.0, 0.5);  // within 0.149 m of axis 1
  try {
    (void)robot->inverse().solve_all(pose);
    FAIL() << "solved";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnreachable);
    EXPECT_NEAR(*error.problem().value, 0.049, 1e-9);
  }
}

TEST(SphericalWrist, AnArmThatIsNotQuiteOneIsSolvedFromItsClosedForm) {
  RobotDescription description = load_description(VIAPOINT_TEST_ROBOTS "/puma560.yaml");
  description.chain[4].before.translation().x() += 1e-4;  // calibrated: the axes miss by 0.1 mm
  const RobotPtr robot = RobotModel::make(description);
  EXPECT_NE(robot->inverse().family().find("spherical wrist"), std::string::npos);
  EXPECT_NE(robot->inverse().family().find("out of true by up to 0.0002 m"), std::string::npos)
      << robot->inverse().family();
  std::mt19937_64 generator(28);
  for (int problem = 0; problem < 500; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const JointVector found = robot->inverse().solve_near(robot->fk(q), q);
    ASSERT_LT(pose_distance(robot->fk(found), robot->fk(q)), 2e-9);
  }
}

}  // namespace
}  // namespace viapoint
