// The proof of the closed forms over many seeded poses: the joints that made a pose are among its
// branches, every branch gives the pose, and what is out of reach is refused by its distance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinematics/arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

constexpr int kProblems = 10'000;

::testing::AssertionResult gives(const RobotModel& robot, const JointVector& q, const Pose& pose,
                                 double tolerance) {
  const Pose reached = robot.forward().pose(q);
  const double off = (reached.translation() - pose.translation()).norm();
  const double turned = rotation_distance(reached.linear(), pose.linear());
  if (off <= tolerance && turned <= tolerance && robot.limits().contains(q, 1e-12)) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << q.transpose() << " is off by " << off << " m, " << turned
                                       << " rad, or outside the limits";
}

TEST(ClosedForms, FindTheJointsThatMadeThePoseAmongExactBranches) {
  for (const char* name : {"puma560", "ur5e", "scara", "rpp", "two_link"}) {
    const RobotPtr robot = arm(name);
    std::mt19937_64 generator(91);
    for (int problem = 0; problem < kProblems; ++problem) {
      SCOPED_TRACE(testing::Message() << name << " seed 91 problem " << problem);
      const JointVector q = random_joints(*robot, generator);
      const Pose pose = robot->forward().pose(q);
      BranchSet branches;
      ASSERT_EQ(robot->inverse().solve_branches(pose, q, branches), BranchStatus::kSolved);
      double nearest = 1e300;
      for (const JointVector& branch : branches) {
        ASSERT_TRUE(gives(*robot, branch, pose, 1e-9));
        nearest = std::min(nearest, (branch - q).lpNorm<Eigen::Infinity>());
      }
      ASSERT_LT(nearest, 1e-6);
    }
  }
}

TEST(ClosedForms, SolveNearEachSingularityTo1e7) {
  // θ5 within 1e-12 … 1e-3 of alignment, the elbow stretched or folded as much, and both.
  for (const char* name : {"puma560", "ur5e", "panda", "iiwa14", "scara", "two_link"}) {
    const RobotPtr robot = arm(name);
    const bool has_wrist = robot->joints() >= 6;
    const Eigen::Index elbow = robot->joints() == 7 ? 3 : (has_wrist ? 2 : 1);
    const Eigen::Index wrist = robot->joints() == 7 ? 5 : 4;
    std::mt19937_64 generator(92);
    for (int problem = 0; problem < 2000; ++problem) {
      SCOPED_TRACE(testing::Message() << name << " seed 92 problem " << problem);
      JointVector q = random_joints(*robot, generator);
      const double offset = std::pow(10.0, -12.0 + problem % 10);
      const double aligned = std::string(name) == "panda" ? kPi / 2.0 : 0.0;
      if (has_wrist && problem % 3 != 0) q[wrist] = aligned + offset;
      if (problem % 3 != 1) {
        const double stretched =
            std::string(name) == "puma560" ? -kPi / 2.0 + std::atan2(0.02, 0.433) : 0.0;
        q[elbow] = stretched - offset;
      }
      if (!robot->limits().contains(q)) continue;
      const Pose pose = robot->forward().pose(q);
      JointVector found;
      ASSERT_NO_THROW(found = robot->inverse().solve_near(pose, q));
      ASSERT_TRUE(gives(*robot, found, pose, 1e-7));
    }
  }
}

TEST(ClosedForms, SolveEveryPoseOfTheRightAngleGrid) {
  for (const char* name : {"puma560", "ur5e", "scara", "rpp", "two_link", "panda", "iiwa14"}) {
    const RobotPtr robot = arm(name);
    const JointLimits& limits = robot->limits();
    std::mt19937_64 generator(94);
    int solved = 0;
    for (int problem = 0; problem < 2000; ++problem) {
      SCOPED_TRACE(testing::Message() << name << " seed 94 problem " << problem);
      JointVector q = random_joints(*robot, generator);
      for (int i = 0; i < q.size(); ++i) {
        if (robot->forward().type(i) == JointType::kPrismatic) continue;
        q[i] = std::round(q[i] / (kPi / 2.0)) * (kPi / 2.0);
      }
      if (!limits.contains(q)) continue;
      const Pose pose = robot->forward().pose(q);
      JointVector found;
      ASSERT_NO_THROW(found = robot->inverse().solve_near(pose, q)) << q.transpose();
      ASSERT_TRUE(gives(*robot, found, pose, 1e-7));
      ++solved;
    }
    EXPECT_GT(solved, 100) << name;
  }
}

TEST(ClosedForms, SolveWhereTheWristIsOnTheShoulderAxis) {
  // Joint 2 is turned until the wrist changes from before axis 1 to behind it, to the last bit, and
  // on by as much as 1e-12 … 1e-3.
  for (const char* name : {"puma560", "ur5e"}) {
    const RobotPtr robot = arm(name);
    const InverseKinematics& inverse = robot->inverse();
    std::mt19937_64 generator(95);
    int solved = 0;
    for (int problem = 0; problem < 2000; ++problem) {
      SCOPED_TRACE(testing::Message() << name << " seed 95 problem " << problem);
      JointVector q = random_joints(*robot, generator);
      const auto side = [&](double turn) {
        JointVector turned = q;
        turned[1] = turn;
        return inverse.configuration(turned).shoulder;
      };
      const double low = robot->limits().position_min[1];
      const double high = robot->limits().position_max[1];
      constexpr int kSteps = 16;
      double from = low;
      double to = low;
      const int before = side(from);
      for (int step = 1; step <= kSteps && side(to) == before; ++step) {
        from = to;
        to = low + (high - low) * step / kSteps;
      }
      if (before == 0 || side(to) == before) continue;
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (from + to);
        (side(middle) == before ? from : to) = middle;
      }
      q[1] = from + (problem % 11 == 0 ? 0.0 : std::pow(10.0, -13.0 + problem % 11));
      if (!robot->limits().contains(q)) continue;
      const Pose pose = robot->forward().pose(q);
      JointVector found;
      ASSERT_NO_THROW(found = inverse.solve_near(pose, q)) << q.transpose();
      ASSERT_TRUE(gives(*robot, found, pose, 1e-7));
      ++solved;
    }
    EXPECT_GT(solved, 500) << name;
  }
}

TEST(ClosedForms, RefuseTheTwoLinksOutOfReachByTheirDistance) {
  for (const char* name : {"scara", "two_link"}) {
    const RobotPtr robot = arm(name);
    std::mt19937_64 generator(96);
    for (int problem = 0; problem < 2000; ++problem) {
      SCOPED_TRACE(testing::Message() << name << " seed 96 problem " << problem);
      JointVector q = random_joints(*robot, generator);
      q[1] = 0.0;  // stretched
      const ChainFrames frames = robot->forward().frames(q);
      Eigen::Vector3d along = frames.pose_base_tool.translation() - frames.origin[0];
      along -= frames.axis[0].dot(along) * frames.axis[0];
      const double beyond = std::pow(10.0, -6.0 + problem % 7);
      Pose pose = frames.pose_base_tool;
      pose.translation() += beyond * along.normalized();
      try {
        (void)robot->inverse().solve_near(pose, q);
        FAIL() << "solved";
      } catch (const MotionError& error) {
        ASSERT_EQ(error.code(), ErrorCode::kUnreachable) << error.what();
        ASSERT_NEAR(*error.problem().value, beyond, 1e-8);
      }
    }
  }
}

TEST(ClosedForms, RefuseWhatIsOutOfReachByItsDistance) {
  // The stretched arm, its wrist pushed on by 1 µm to 1 m along the line from shoulder to wrist.
  for (const char* name : {"puma560", "ur5e"}) {
    const RobotPtr robot = arm(name);
    const bool puma = std::string(name) == "puma560";
    std::mt19937_64 generator(93);
    int refused = 0;
    for (int problem = 0; problem < 2000; ++problem) {
      SCOPED_TRACE(testing::Message() << name << " seed 93 problem " << problem);
      JointVector q = random_joints(*robot, generator);
      q[2] = puma ? kPi / 2.0 + std::atan2(0.02, 0.433) : 0.0;
      const ChainFrames frames = robot->forward().frames(q);
      // Across axis 2: from axis 2 to axis 4 (UR), or to the wrist centre (PUMA).
      Eigen::Vector3d along = frames.origin[puma ? 5 : 3] - frames.origin[1];
      along -= frames.axis[1].dot(along) * frames.axis[1];
      const double beyond = std::pow(10.0, -6.0 + problem % 7);
      Pose pose = frames.pose_base_tool;
      pose.translation() += beyond * along.normalized();
      try {
        const JointVector found = robot->inverse().solve_near(pose, q);
        ASSERT_TRUE(gives(*robot, found, pose, 1e-9));  // on another branch
      } catch (const MotionError& error) {
        if (error.code() == ErrorCode::kOutsideLimits) continue;
        ASSERT_EQ(error.code(), ErrorCode::kUnreachable);
        ASSERT_GT(*error.problem().value, 0.0);
        ASSERT_LT(*error.problem().value, beyond + 1e-9);
        if (puma) {
          ASSERT_NEAR(*error.problem().value, beyond, 1e-9);
        }
        ++refused;
      }
    }
    EXPECT_GT(refused, puma ? 1900 : 500);
  }
}

TEST(ClosedForms, RefuseSevenJointsOutOfReachByTheirDistance) {
  // The flange beyond the stretched arm, along the line on which it points away from the shoulder:
  // whatever the redundancy, the wrist cannot be nearer. Panda's wrist lies 88 mm beside that line.
  struct Arm {
    const char* name;
    double shoulder, links, flange, beside;
  };
  const double panda_links = std::hypot(0.316, 0.0825) + std::hypot(0.384, 0.0825);
  for (const Arm& of :
       {Arm{"iiwa14", 0.36, 0.82, 0.126, 0.0}, Arm{"panda", 0.333, panda_links, 0.107, 0.088}}) {
    const RobotPtr robot = arm(of.name);
    const double stretched = std::sqrt(of.links * of.links - of.beside * of.beside);
    std::mt19937_64 generator(97);
    std::normal_distribution<double> normal;
    for (int problem = 0; problem < 700; ++problem) {
      SCOPED_TRACE(testing::Message() << of.name << " seed 97 problem " << problem);
      const Eigen::Vector3d along =
          Eigen::Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
      const double beyond = std::pow(10.0, -6.0 + problem % 7);
      Pose pose = Pose::Identity();
      pose.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along));
      pose.rotate(Eigen::AngleAxisd(normal(generator), Eigen::Vector3d::UnitZ()));
      pose.translation() =
          of.shoulder * Eigen::Vector3d::UnitZ() + (stretched + beyond + of.flange) * along;
      const double missing = std::hypot(stretched + beyond, of.beside) - of.links;
      try {
        (void)robot->inverse().solve_near(pose, random_joints(*robot, generator));
        FAIL() << "solved";
      } catch (const MotionError& error) {
        ASSERT_EQ(error.code(), ErrorCode::kUnreachable) << error.what();
        ASSERT_NEAR(*error.problem().value, missing, 1e-8);
      }
    }
  }
}

}  // namespace
}  // namespace viapoint
