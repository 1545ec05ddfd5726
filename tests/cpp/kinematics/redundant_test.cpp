// Arms with seven joints: every branch at a given redundancy, near joints, along paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kinematics/arms.hpp"
#include "kinematics/redundant_form.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

class SevenJoints : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(InverseKinematics, SevenJoints, testing::Values("panda", "iiwa14"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(SevenJoints, FindTheGeneratingJointsAtTheirRedundancy) {
  const RobotPtr robot = arm(GetParam());
  const InverseKinematics& inverse = robot->inverse();
  std::mt19937_64 generator(81);
  size_t most = 0;
  for (int problem = 0; problem < 3000; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const Pose pose = robot->fk(q);
    const auto all = inverse.solve_all_at(pose, inverse.redundancy_of(q), q);
    ASSERT_LT((all[0] - q).lpNorm<Eigen::Infinity>(), 1e-6);
    for (const JointVector& each : all) {
      ASSERT_TRUE(robot->limits().contains(each));
      ASSERT_LT(pose_distance(robot->fk(each), pose), 2e-9);
      const double off = inverse.redundancy_of(each) - inverse.redundancy_of(q);
      ASSERT_NEAR(std::remainder(off, 2.0 * kPi), 0.0, 1e-6);
    }
    most = std::max(most, all.size());
  }
  EXPECT_GE(most, 2u);
}

TEST_P(SevenJoints, GiveTheBranchesAtTheRedundancyOfNearWithoutAHeap) {
  const RobotPtr robot = arm(GetParam());
  const InverseKinematics& inverse = robot->inverse();
  std::mt19937_64 generator(86);
  for (int problem = 0; problem < 1000; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const Pose pose = robot->forward().pose(q);
    BranchSet branches;
    BranchStatus status{};
    std::uint64_t calls = 0;
    {
      const NoAllocationScope scope;
      status = inverse.solve_branches(pose, q, branches);
      calls = scope.calls();
    }
    ASSERT_EQ(calls, 0u);
    ASSERT_EQ(status, BranchStatus::kSolved);
    double nearest = 1e300;
    for (const JointVector& branch : branches) {
      ASSERT_TRUE(robot->limits().contains(branch));
      ASSERT_LT(pose_distance(robot->fk(branch), pose), 2e-9);
      const double off = inverse.redundancy_of(branch) - inverse.redundancy_of(q);
      ASSERT_NEAR(std::remainder(off, 2.0 * kPi), 0.0, 1e-6);
      nearest = std::min(nearest, (branch - q).lpNorm<Eigen::Infinity>());
    }
    ASSERT_LT(nearest, 1e-6);
  }
}

TEST_P(SevenJoints, GiveOneSolutionForEachConfiguration) {
  const RobotPtr robot = arm(GetParam());
  const InverseKinematics& inverse = robot->inverse();
  std::mt19937_64 generator(82);
  constexpr int kProblems = 200;
  int same_sides = 0;
  for (int problem = 0; problem < kProblems; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const auto all = inverse.solve_all(robot->fk(q));
    std::set<std::string> names;
    bool found = false;
    for (const JointVector& each : all) {
      const Configuration side = inverse.configuration(each);
      ASSERT_TRUE(names.insert(side.describe()).second) << side.describe();
      found = found || side.fits(inverse.configuration(q));
      ASSERT_TRUE(robot->limits().contains(each));
      ASSERT_LT(pose_distance(robot->fk(each), robot->fk(q)), 2e-9);
    }
    ASSERT_FALSE(all.empty());
    same_sides += found ? 1 : 0;
  }
  EXPECT_EQ(same_sides, kProblems);
}

TEST_P(SevenJoints, FindTheConfigurationOfThePoseUnderAnyLimits) {
  // Limits as no arm has them: some of a few hundredths of a radian about the joints, some of
  // more than a turn, where configurations live on short stretches of the redundancy only.
  for (const bool narrow : {true, false}) {
    std::mt19937_64 generator(88);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int problem = 0; problem < 120; ++problem) {
      SCOPED_TRACE(testing::Message() << (narrow ? "narrow" : "wide") << ", problem " << problem);
      RobotDescription description = load_description(GetParam());
      JointLimits& limits = description.limits;
      if (!narrow) {
        limits.position_min.setConstant(-3.6);
        limits.position_max.setConstant(3.3);
      }
      JointVector q(7);
      for (int i = 0; i < 7; ++i) {
        const double low = limits.position_min[i];
        q[i] = low + (limits.position_max[i] - low) * share(generator);
        if (!narrow || i % 2 == 1) continue;
        limits.position_min[i] = q[i] - 0.01 - 0.4 * share(generator);
        limits.position_max[i] = q[i] + 0.01 + 0.4 * share(generator);
      }
      const RobotPtr robot = RobotModel::make(description);
      const InverseKinematics& inverse = robot->inverse();
      Configuration made_by = inverse.configuration(q);
      if (!narrow) made_by.turns = TurnVector();  // of wide limits the near turns are kept only
      bool found = false;
      for (const JointVector& each : inverse.solve_all(robot->fk(q))) {
        found = found || inverse.configuration(each).fits(made_by);
      }
      ASSERT_TRUE(found) << made_by.describe();
    }
  }
}

TEST_P(SevenJoints, ASieveDropsOnlyBranchesThatBreakIt) {
  const RobotPtr robot = arm(GetParam());
  const auto form = recognise_redundant_form(robot->forward());
  const JointTurns turns(robot->forward(), robot->limits());
  std::mt19937_64 generator(89);
  std::uniform_real_distribution<double> bound(0.5, 30.0);
  int dropped = 0;
  int kept = 0;
  for (int problem = 0; problem < 3000; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const JointVector near = random_joints(*robot, generator);
    const double most = bound(generator);
    ClosedSolutions all;
    ClosedSolutions sieved;
    form->solve(robot->fk(q), form->parameter_of(q), near, all);
    form->solve(robot->fk(q), form->parameter_of(q), near, sieved, JointSieve(turns, near, most));
    for (const ClosedBranch& branch : all.branches) {
      const auto turned = turns.nearest(branch.q, near);
      if (!turned || (*turned - near).squaredNorm() > most) continue;
      ++kept;
      const bool there =
          std::any_of(sieved.branches.begin(), sieved.branches.end(),
                      [&](const ClosedBranch& each) { return (each.q - branch.q).norm() == 0.0; });
      ASSERT_TRUE(there) << branch.q.transpose();
    }
    dropped += all.branches.size() - sieved.branches.size();
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(dropped, 1000);
}

TEST_P(SevenJoints, GiveTheNearTurnsHoweverWideTheLimits) {
  const RobotPtr own = arm(GetParam());
  for (const auto& [limit, problems] : {std::pair{2.0 * kPi, 8}, {50.0, 1}, {1e9, 1}}) {
    RobotDescription description = load_description(GetParam());
    description.limits.position_min.setConstant(-limit);
    description.limits.position_max.setConstant(limit);
    const RobotPtr robot = RobotModel::make(description);
    std::mt19937_64 generator(87);
    for (int problem = 0; problem < problems; ++problem) {
      SCOPED_TRACE(testing::Message() << "limits " << limit << ", problem " << problem);
      const JointVector q = random_joints(*own, generator);
      const auto all = robot->inverse().solve_all(robot->fk(q));
      const Configuration made_by = robot->inverse().configuration(q);
      bool found = false;
      for (const JointVector& each : all) {
        ASSERT_LT(pose_distance(robot->fk(each), robot->fk(q)), 2e-9);
        if (found || each.lpNorm<Eigen::Infinity>() > kPi + 1e-9) continue;
        const Configuration side = robot->inverse().configuration(each);
        found = side.shoulder == made_by.shoulder && side.elbow == made_by.elbow &&
                side.wrist == made_by.wrist;
      }
      ASSERT_TRUE(found);
      ASSERT_LT(all.size(), 100'000U);  // of each branch 4096 turns at most
    }
  }
}

TEST_P(SevenJoints, SolveSingularPoses) {
  const RobotPtr robot = arm(GetParam());
  std::mt19937_64 generator(83);
  for (const double offset : {0.0, 1e-12, 1e-10, 1e-8, 1e-6, 1e-3}) {
    for (int joint = 0; joint <= 7; ++joint) {
      for (int problem = 0; problem < 20; ++problem) {
        SCOPED_TRACE(testing::Message() << offset << " joint " << joint << " " << problem);
        JointVector q = random_joints(*robot, generator);
        for (int i = 0; i < 7; ++i) {
          if (i != joint && joint != 7) continue;
          q[i] = std::round(q[i] / (kPi / 2.0)) * (kPi / 2.0) + offset;
        }
        if (!robot->limits().contains(q)) continue;
        const Pose pose = robot->fk(q);
        JointVector found;
        ASSERT_NO_THROW(found = robot->inverse().solve_near(pose, q));
        ASSERT_TRUE(robot->limits().contains(found));
        ASSERT_LT(pose_distance(robot->fk(found), pose), 2e-9);
      }
    }
  }
}

TEST_P(SevenJoints, FollowAPathInSmallSteps) {
  // Poses along a joint-space line: the joints may differ from the line's, but never jump.
  const RobotPtr robot = arm(GetParam());
  std::mt19937_64 generator(84);
  constexpr int kSteps = 100;
  for (int path = 0; path < 50; ++path) {
    SCOPED_TRACE(path);
    const JointVector middle = 0.5 * (robot->limits().position_min + robot->limits().position_max);
    const JointVector start = middle + 0.6 * (random_joints(*robot, generator) - middle);
    const JointVector end = start + 0.15 * (random_joints(*robot, generator) - middle);
    JointVector q = start;
    for (int step = 1; step <= kSteps; ++step) {
      const Pose pose = robot->fk(start + (end - start) * (static_cast<double>(step) / kSteps));
      JointVector next;
      ASSERT_NO_THROW(next = robot->inverse().solve_near(pose, q));
      ASSERT_LT((next - q).lpNorm<Eigen::Infinity>(), 0.05) << "step " << step;
      q = next;
    }
  }
}

TEST(SevenJoint, SayWhatTheyLeaveOpen) {
  EXPECT_EQ(arm("panda")->inverse().redundancy(), "joint 7");
  EXPECT_EQ(arm("iiwa14")->inverse().redundancy(), "arm angle");
  EXPECT_EQ(arm("puma560")->inverse().redundancy(), "");
  try {
    (void)arm("puma560")->inverse().redundancy_of(JointVector::Zero(6));
    FAIL() << "answered";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUncontrolled);
  }
}

TEST(SevenJoint, TheArmAngleIsThatOfTheElbowAboutTheLineToTheWrist) {
  const RobotPtr robot = arm("iiwa14");
  const InverseKinematics& inverse = robot->inverse();
  JointVector q(7);
  q << 0.3, 0.7, 0.0, -1.2, 0.4, 0.9, -0.2;  // joint 3 at zero: the arm's plane holds axis 1
  const double flat = inverse.redundancy_of(q);
  EXPECT_NEAR(std::sin(flat), 0.0, 1e-12);
  const Pose pose = robot->fk(q);
  for (const double turn : {-0.8, 0.3, 1.1}) {
    SCOPED_TRACE(turn);
    const auto all = inverse.solve_all_at(pose, flat + turn, q);
    const ChainFrames frames = robot->forward().frames(all[0]);
    const ChainFrames before = robot->forward().frames(q);
    const Eigen::Vector3d shoulder = before.origin[1];
    const Eigen::Vector3d along = (before.origin[5] - shoulder).normalized();
    const Eigen::Vector3d expected =
        shoulder + Eigen::AngleAxisd(turn, along) * (before.origin[3] - shoulder);
    EXPECT_LT((frames.origin[3] - expected).norm(), 1e-9);
  }
}

TEST(SevenJoint, OutOfReachIsMeasured) {
  const RobotPtr robot = arm("iiwa14");
  std::mt19937_64 generator(85);
  for (const double beyond : {1e-6, 1e-4, 1e-2, 1.0}) {
    for (int problem = 0; problem < 20; ++problem) {
      SCOPED_TRACE(testing::Message() << beyond << " problem " << problem);
      JointVector q = random_joints(*robot, generator);
      q[3] = 0.0;  // stretched: shoulder to wrist 0.82 m
      Pose pose = robot->fk(q);
      const ChainFrames frames = robot->forward().frames(q);
      pose.translation() += beyond * (frames.origin[5] - frames.origin[1]).normalized();
      try {
        (void)robot->inverse().solve_near(pose, q);
        FAIL() << "solved";
      } catch (const MotionError& error) {
        ASSERT_EQ(error.code(), ErrorCode::kUnreachable);
        ASSERT_NEAR(*error.problem().value, beyond, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace viapoint
