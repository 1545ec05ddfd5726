// Random programs of mixed moves: each ends in a certified motion or a named error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planning/planner_fixture.hpp"
#include "planning/random_program.hpp"
#include "problem_count.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;

struct Sweep {
  const char* robot;
  unsigned wild;      ///< short programs, much of them impossible
  unsigned programs;  ///< of 2 to 200 moves, that are mostly possible
};

class RandomPrograms : public ::testing::TestWithParam<Sweep> {
 protected:
  /// Errors that the planner must not make itself, and none without its line.
  static void expect_named(const Report& report) {
    for (const Problem& problem : report.problems) {
      ASSERT_NE(problem.code, ErrorCode::kInternal) << problem.describe();
      ASSERT_NE(problem.code, ErrorCode::kDiscontinuous) << problem.describe();
      // As a warning: a speed that was asked for and cannot be kept.
      if (problem.severity == Severity::kError) {
        ASSERT_NE(problem.code, ErrorCode::kVelocityLimit) << problem.describe();
        ASSERT_NE(problem.code, ErrorCode::kAccelerationLimit) << problem.describe();
        ASSERT_NE(problem.code, ErrorCode::kJerkLimit) << problem.describe();
      }
      ASSERT_FALSE(problem.message.empty());
      // Only of a program as a whole there is no line.
      ASSERT_TRUE(problem.line.has_value() || problem.code == ErrorCode::kEmptyProgram)
          << problem.describe();
    }
  }

  /// Independent of the certificate: samples keep every limit.
  void expect_limits_kept(const Trajectory& trajectory, int samples) const {
    const JointLimits& limits = arm_->limits();
    for (int k = 0; k <= samples; ++k) {
      const JointState state = trajectory.at(trajectory.duration() * k / samples);
      ASSERT_TRUE(limits.contains(state.q, 1e-9));
      for (int i = 0; i < arm_->joints(); ++i) {
        ASSERT_LE(std::abs(state.qd[i]), limits.velocity[i] * (1 + 1e-6));
        ASSERT_LE(std::abs(state.qdd[i]), limits.acceleration[i] * (1 + 1e-6));
        ASSERT_LE(std::abs(state.qddd[i]), limits.jerk[i] * (1 + 1e-6));
      }
    }
  }

  /// Leaves out what is refused until the rest is a motion, and looks at that.
  void plan_what_can_be(MotionProgram& program) const {
    while (!program.steps.empty()) {
      try {
        const Trajectory motion = planner_.plan(program).trajectory;
        ASSERT_TRUE(motion.certificate().holds());
        expect_limits_kept(motion, 1000);
        return;
      } catch (const MotionError&) {
        const Report report = planner_.check(program);
        ASSERT_NO_FATAL_FAILURE(expect_named(report));
        ASSERT_TRUE(leave_out_errors(program, report)) << report.describe();
      }
    }
  }

  RobotPtr arm_ = robot(GetParam().robot);
  MotionPlanner planner_{arm_};
};

TEST_P(RandomPrograms, EndInACertifiedMotionOrANamedError) {
  unsigned planned = 0;
  for (unsigned seed = 0; seed < problems(GetParam().wild); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    ProgramKind kind;
    kind.moves = 1 + random() % 4;
    const MotionProgram program = random_program(*arm_, kind, random);
    const Report report = planner_.check(program);
    ASSERT_NO_FATAL_FAILURE(expect_named(report));
    if (!report.ok()) {
      ASSERT_THROW((void)planner_.plan(program), MotionError);
      continue;
    }
    const PlannedMotion motion = planner_.plan(program);
    ASSERT_TRUE(motion.trajectory.certificate().holds());
    ASSERT_NO_FATAL_FAILURE(expect_limits_kept(motion.trajectory, 500));
    ++planned;
  }
  // The sweep must mean something: a good part of the programs run.
  EXPECT_GE(planned, problems(GetParam().wild) / 5);
}

TEST_P(RandomPrograms, OfUpToTwoHundredMovesRunWithoutTheMovesThatAreRefused) {
  size_t moves = 0, left = 0;
  for (unsigned seed = 0; seed < problems(GetParam().programs); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    ProgramKind kind;
    kind.moves = random_length(random);
    kind.wild = 0.0;
    MotionProgram program = random_program(*arm_, kind, random);
    moves += program.steps.size();
    ASSERT_NO_FATAL_FAILURE(plan_what_can_be(program));
    left += program.steps.size();
  }
  EXPECT_GT(left, moves / 2);
}

INSTANTIATE_TEST_SUITE_P(Robots, RandomPrograms,
                         ::testing::Values(Sweep{"puma560", 90, 20}, Sweep{"scara", 40, 15},
                                           Sweep{"ur5e", 12, 8}, Sweep{"panda", 12, 2}),
                         [](const auto& instance) { return std::string(instance.param.robot); });

}  // namespace
}  // namespace viapoint
