// A program in chunks: the path of the whole, a timing without steps, and rest whenever nothing
// more comes.
#include "viapoint/planning/stream_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planning/planner_fixture.hpp"
#include "planning/random_program.hpp"
#include "planning/stream_fixture.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;

JointVector near_by(const RobotModel& robot, const JointVector& q, double reach,
                    std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-reach, reach);
  JointVector next = q;
  for (int i = 0; i < q.size(); ++i) {
    const double low = robot.limits().position_min[i], high = robot.limits().position_max[i];
    const double span = std::min(high - low, 6.0);
    next[i] = std::clamp(q[i] + uniform(random) * span, low + 0.1 * span, high - 0.1 * span);
  }
  return next;
}

/// Hands the steps over in bursts, and plays what comes.
Played stream(const RobotPtr& robot, const MotionProgram& program, std::mt19937& random) {
  MotionProgram head = program;
  head.steps.clear();
  StreamPlanner planner(robot, head);
  Played played(robot->limits());
  size_t at = 0;
  while (!planner.done()) {
    for (size_t burst = random() % 9; burst > 0 && at < program.steps.size(); --burst) {
      planner.add(program.steps[at++]);
    }
    if (at == program.steps.size()) planner.end();
    while (const auto chunk = planner.next(0.0, random() % 3 == 0)) played.add(*chunk);
  }
  played.finish();
  EXPECT_FALSE(planner.next().has_value());
  played.stops = planner.stops();
  return played;
}

struct Sweep {
  const char* robot;
  unsigned programs;
  size_t most_moves;
};

class RandomStreams : public testing::TestWithParam<Sweep> {};

TEST_P(RandomStreams, AreTheWholeProgramInChunks) {
  const RobotPtr arm = robot(GetParam().robot);
  const MotionPlanner planner(arm);
  for (unsigned seed = 0; seed < GetParam().programs; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const size_t moves = 2 + random() % GetParam().most_moves;
    ProgramKind kind;
    kind.moves = moves;
    kind.wild = 0.0;
    kind.curves = false;
    MotionProgram program = random_program(*arm, kind, random);
    for (Report report = planner.check(program); !report.ok(); report = planner.check(program)) {
      ASSERT_TRUE(leave_out_errors(program, report)) << report.describe();
    }
    const PlannedMotion whole = planner.plan(program);
    const Played played = stream(arm, program, random);
    EXPECT_EQ(played.problem, "");
    EXPECT_LE(off_path(played.pieces, whole.trajectory.pieces()), 1e-12);
    EXPECT_EQ(changes_of(played.pieces), changes_of(whole.trajectory.pieces()));
    ASSERT_EQ(played.corners.size(), whole.corners.size());
    for (size_t k = 0; k < whole.corners.size(); ++k) {
      EXPECT_EQ(played.corners[k].move, whole.corners[k].move);
      EXPECT_EQ(played.corners[k].used, whole.corners[k].used);
      EXPECT_EQ(played.corners[k].stopped, whole.corners[k].stopped);
    }
    EXPECT_EQ(played.warnings, whole.report.problems.size());
    // What was played is a motion from rest to rest by itself.
    const Trajectory motion(played.pieces, arm->limits());
    EXPECT_TRUE(motion.certificate().holds());
    EXPECT_LT(motion.certificate().acceleration_jump, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, RandomStreams,
                         testing::Values(Sweep{"puma560", 30, 12}, Sweep{"ur5e", 20, 12},
                                         Sweep{"scara", 20, 12}, Sweep{"puma560", 3, 198}),
                         [](const auto& tested) {
                           return std::string(tested.param.robot) + "_" +
                                  std::to_string(tested.param.most_moves);
                         });

class Stream : public testing::Test {
 protected:
  /// Moves of joints to and fro, all with corners.
  MotionProgram zigzag(int moves) {
    Script script(*arm_, degrees({0, 20, 0, 10, 50, 10}));
    std::mt19937 random(7);
    JointVector q = script.program().start;
    for (int k = 0; k < moves; ++k) {
      q = near_by(*arm_, q, 0.03, random);
      script.movej(q, {ZoneKind::kJointDeviation, 0.01});
    }
    return script.program();
  }
  static MotionProgram head_of(MotionProgram program) {
    program.steps.clear();
    return program;
  }

  RobotPtr arm_ = robot("puma560");
};

TEST_F(Stream, IsWithinAPercentOfTheWhole) {
  const MotionProgram program = zigzag(150);
  const double whole = MotionPlanner(arm_).plan(program).trajectory.duration();
  StreamPlanner planner(arm_, program);
  planner.end();
  Played played(arm_->limits());
  while (const auto chunk = planner.next()) played.add(*chunk);
  played.finish();
  double duration = 0.0;
  for (const TrajectoryPiece& piece : played.pieces) duration += piece.duration;
  EXPECT_NEAR(duration, whole, 0.01 * whole);
  EXPECT_EQ(planner.stops(), 0);
}

TEST_F(Stream, BeginsWhenAFewMovesAreKnown) {
  const MotionProgram program = zigzag(50);
  StreamPlanner planner(arm_, head_of(program));
  size_t known = 0;
  std::optional<MotionChunk> chunk;
  while (!chunk && known < program.steps.size()) {
    planner.add(program.steps[known++]);
    chunk = planner.next();
  }
  ASSERT_TRUE(chunk.has_value());
  EXPECT_LE(known, 6U);
  EXPECT_FALSE(chunk->last);
}

TEST_F(Stream, RestsOnThePathWhereTheNextChunkComesTooLate) {
  const MotionProgram program = zigzag(40);
  const PlannedMotion whole = MotionPlanner(arm_).plan(program);
  StreamPlanner planner(arm_, head_of(program));
  Played played(arm_->limits());
  double duration = 0.0;
  for (const Step& step : program.steps) {
    planner.add(step);
    if (const auto chunk = planner.next(duration, true)) {
      EXPECT_EQ(chunk->begin, duration);
      played.add(*chunk);
      duration = chunk->motion.duration();
    }
  }
  planner.end();
  while (const auto chunk = planner.next(duration, true)) {
    played.add(*chunk);
    duration = chunk->motion.duration();
  }
  played.finish();
  EXPECT_GT(planner.stops(), 10);
  EXPECT_EQ(played.problem, "");
  EXPECT_LE(off_path(played.pieces, whole.trajectory.pieces()), 1e-12);
}

TEST_F(Stream, IsNotLeftBeforeItIsAllowed) {
  const MotionProgram program = zigzag(60);
  StreamPlanner planner(arm_, head_of(program));
  double not_before = 0.0;
  for (const Step& step : program.steps) {
    planner.add(step);
    if (const auto chunk = planner.next(not_before)) {
      EXPECT_GE(chunk->begin, not_before);
      not_before = 0.3 * chunk->motion.duration();
    }
  }
}

TEST_F(Stream, EndsBeforeAStepThatIsWrong) {
  MotionProgram program = zigzag(6);
  const PlannedMotion whole = MotionPlanner(arm_).plan(program);
  StreamPlanner planner(arm_, head_of(program));
  for (const Step& step : program.steps) planner.add(step);
  Step wrong = program.steps.front();
  std::get<JointTarget>(std::get<PtpMove>(wrong.what).target).q[1] = 100.0;
  wrong.source.line = 77;
  try {
    planner.add(wrong);
    FAIL() << "a target outside the limits was taken";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.problem().code, ErrorCode::kJointLimit);
    EXPECT_EQ(error.problem().line, 77);
    EXPECT_EQ(error.problem().move, 6);
  }
  EXPECT_THROW(planner.add(program.steps.front()), MotionError);
  Played played(arm_->limits());
  while (const auto chunk = planner.next()) played.add(*chunk);
  played.finish();
  EXPECT_LE(off_path(played.pieces, whole.trajectory.pieces()), 1e-12);
}

TEST_F(Stream, RefusesAStartOutsideTheLimits) {
  MotionProgram program = zigzag(1);
  program.start[1] = 100.0;
  EXPECT_THROW(StreamPlanner(arm_, program), MotionError);
}

}  // namespace
}  // namespace viapoint
