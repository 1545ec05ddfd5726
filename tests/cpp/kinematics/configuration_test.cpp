// Configurations: every branch has a name of its own, and is found by it.
#include <gtest/gtest.h>

#include <set>

#include "kinematics/arms.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

const char* const kSixAxes[] = {"puma560", "ur5e"};

/// The arm with every joint free to make one turn.
RobotPtr one_turn(const char* name) {
  const RobotPtr robot = arm(name);
  JointLimits limits = robot->limits();
  limits.position_min.setConstant(-kPi);
  limits.position_max.setConstant(kPi);
  return robot->with_limits(limits);
}

TEST(Configuration, NamesEachOfTheEightBranchesDifferently) {
  for (const char* name : kSixAxes) {
    SCOPED_TRACE(name);
    const RobotPtr robot = one_turn(name);
    std::mt19937_64 generator(61);
    int eights = 0;
    for (int problem = 0; problem < 2000; ++problem) {
      SCOPED_TRACE(problem);
      const auto all = robot->inverse().solve_all(robot->fk(random_joints(*robot, generator)));
      std::set<std::tuple<int, int, int>> names;
      for (const JointVector& q : all) {
        const Configuration found = robot->inverse().configuration(q);
        ASSERT_TRUE(found.shoulder != 0 && found.elbow != 0 && found.wrist != 0);
        names.emplace(found.shoulder, found.elbow, found.wrist);
      }
      ASSERT_EQ(names.size(), all.size());
      eights += all.size() == 8 ? 1 : 0;
    }
    EXPECT_GT(eights, 300);
  }
}

TEST(Configuration, OfTheGeneratingJointsFindsThemAgain) {
  for (const char* name : kSixAxes) {
    SCOPED_TRACE(name);
    const RobotPtr robot = arm(name);
    std::mt19937_64 generator(62);
    for (int problem = 0; problem < 200; ++problem) {
      SCOPED_TRACE(problem);
      const JointVector q = random_joints(*robot, generator);
      const Configuration wish = robot->inverse().configuration(q);
      const auto found =
          robot->inverse().solve_all(robot->fk(q), random_joints(*robot, generator), wish);
      ASSERT_EQ(found.size(), 1u);
      ASSERT_LT((found[0] - q).lpNorm<Eigen::Infinity>(), 1e-6);
    }
  }
}

TEST(Configuration, AWishIsKeptAndTheNearestComesFirst) {
  const RobotPtr robot = arm("ur5e");
  std::mt19937_64 generator(63);
  for (int problem = 0; problem < 100; ++problem) {
    SCOPED_TRACE(problem);
    const JointVector q = random_joints(*robot, generator);
    const JointVector near = random_joints(*robot, generator);
    Configuration wish;
    wish.elbow = robot->inverse().configuration(q).elbow;
    const auto found = robot->inverse().solve_all(robot->fk(q), near, wish);
    for (size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(robot->inverse().configuration(found[i]).elbow, wish.elbow);
      ASSERT_LE((found[0] - near).lpNorm<Eigen::Infinity>(),
                (found[i] - near).lpNorm<Eigen::Infinity>());
    }
  }
}

TEST(Configuration, CountsWholeTurns) {
  const RobotPtr robot = arm("ur5e");
  JointVector q(6);
  q << 0.1, kPi, -kPi, kPi + 0.1, -kPi - 0.1, 2.0 * kPi;
  const TurnVector turns = robot->inverse().configuration(q).turns;
  TurnVector expected(6);
  expected << 0, 0, -1, 1, -1, 1;
  EXPECT_EQ(turns, expected);
}

TEST(Configuration, ASingularSideFitsEitherWish) {
  const RobotPtr robot = arm("puma560");
  JointVector q(6);
  q << 0.3, -0.4, 0.5, 0.6, 0.0, 0.2;
  EXPECT_EQ(robot->inverse().configuration(q).wrist, 0);
  for (const int side : {-1, 1}) {
    Configuration wish;
    wish.wrist = side;
    EXPECT_FALSE(robot->inverse().solve_all(robot->fk(q), q, wish).empty());
  }
}

TEST(Configuration, OneThatIsNotThereIsRefusedWithTheOnesThatAre) {
  const RobotPtr robot = arm("puma560");
  JointVector q(6);
  q << 0.3, -0.4, 0.5, 0.6, 0.7, 0.2;
  Configuration wish = robot->inverse().configuration(q);
  wish.turns[0] = 1;  // joint 1 allows ±160°
  try {
    (void)robot->inverse().solve_all(robot->fk(q), q, wish);
    FAIL() << "solved";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutsideLimits);
    wish.turns[0] = 0;
    EXPECT_NE(error.problem().message.find("there are: "), std::string::npos);
    EXPECT_NE(error.problem().message.find(wish.describe()), std::string::npos);
  }
}

TEST(Configuration, TurnsUnderCoupledLimitsAreExactlyThoseThatKeepThem) {
  // C q couples joints 5 and 6 of the UR: of all turns only those with their sum in range count.
  JointLimits limits = arm("ur5e")->limits();
  limits.coupling.setZero(1, 6);
  limits.coupling(0, 4) = 1.0;
  limits.coupling(0, 5) = 1.0;
  limits.coupling_lower = CouplingVector::Constant(1, -2.0);
  limits.coupling_upper = CouplingVector::Constant(1, 2.0);
  const RobotPtr free = arm("ur5e");
  const RobotPtr coupled = free->with_limits(limits);
  std::mt19937_64 generator(64);
  int dropped = 0;
  for (int problem = 0; problem < 100; ++problem) {
    SCOPED_TRACE(problem);
    JointVector q = random_joints(*free, generator);
    while (!limits.contains(q)) q = random_joints(*free, generator);
    const Pose pose = free->fk(q);
    const auto all = free->inverse().solve_all(pose);
    size_t expected = 0;
    for (const JointVector& each : all) expected += limits.contains(each) ? 1 : 0;
    const auto found = coupled->inverse().solve_all(pose);
    ASSERT_EQ(found.size(), expected);
    for (const JointVector& each : found) ASSERT_TRUE(limits.contains(each, 1e-11));
    dropped += found.size() < all.size() ? 1 : 0;
  }
  EXPECT_GT(dropped, 50);
}

TEST(Configuration, BranchesComeWithoutTheHeapAndAreThoseOfTheSearchForAll) {
  for (const char* name : kSixAxes) {
    SCOPED_TRACE(name);
    const RobotPtr robot = one_turn(name);
    std::mt19937_64 generator(65);
    for (int problem = 0; problem < 1000; ++problem) {
      SCOPED_TRACE(problem);
      const Pose pose = robot->fk(random_joints(*robot, generator));
      const JointVector near = random_joints(*robot, generator);
      BranchSet branches;
      BranchStatus status;
      std::uint64_t calls = 0;
      {
        const NoAllocationScope scope;
        status = robot->inverse().solve_branches(pose, near, branches);
        calls = scope.calls();
      }
      ASSERT_EQ(calls, 0u);
      ASSERT_EQ(status, BranchStatus::kSolved);
      const auto all = robot->inverse().solve_all(pose, near);
      ASSERT_EQ(static_cast<size_t>(branches.size()), all.size());
      for (const JointVector& q : branches) {
        ASSERT_TRUE(std::any_of(all.begin(), all.end(), [&](const JointVector& each) {
          return (each - q).lpNorm<Eigen::Infinity>() < 1e-9;
        }));
      }
    }
  }
}

TEST(Configuration, BranchesThatAreNotThereHaveAStatus) {
  const RobotPtr robot = arm("puma560");
  const JointVector near = JointVector::Zero(6);
  BranchSet branches;
  Pose pose = robot->fk(near);
  EXPECT_EQ(robot->inverse().solve_branches(pose, near, branches), BranchStatus::kSolved);
  EXPECT_GT(branches.size(), 0);
  EXPECT_EQ(robot->inverse().solve_branches(pose, JointVector::Zero(5), branches),
            BranchStatus::kBadArgument);
  EXPECT_EQ(branches.size(), 0);
  pose.translation().x() += 5.0;
  EXPECT_EQ(robot->inverse().solve_branches(pose, near, branches), BranchStatus::kUnreachable);
  pose.linear() *= 1.1;
  EXPECT_EQ(robot->inverse().solve_branches(pose, near, branches), BranchStatus::kBadArgument);
  JointLimits limits = robot->limits();
  limits.position_min.setConstant(0.1);
  limits.position_max.setConstant(0.2);
  EXPECT_EQ(robot->with_limits(limits)->inverse().solve_branches(robot->fk(near), near, branches),
            BranchStatus::kOutsideLimits);
}

}  // namespace
}  // namespace viapoint
