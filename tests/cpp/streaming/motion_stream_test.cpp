// A program that is run while it is told: nothing is lost, nothing is jumped, and what comes too
// late costs a rest on the path and no more.
#include "viapoint/streaming/motion_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "planning/planner_fixture.hpp"
#include "planning/stream_fixture.hpp"
#include "problem_count.hpp"
#include "streaming/handed.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/virtual_loop.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;

constexpr double kCycle = 2e-3;
constexpr double kMargin = 2 * kCycle;

/// Moves of the joints and of the tool, all but some rounded, with outputs between them.
MotionProgram some_moves(const RobotModel& robot, int moves, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  JointVector home(6);
  home << 0.0, 0.4, 0.0, 0.3, 0.9, 0.2;
  Script script(robot, home);
  JointVector q = home;
  for (int k = 0; k < moves; ++k) {
    for (int i = 0; i < 6; ++i) q[i] = home[i] + 0.2 * uniform(random);
    MoveOptions options;
    if (random() % 5 != 0) options.zone = {ZoneKind::kJointDeviation, 0.02};
    if (random() % 4 == 0) {
      script.add(LinMove{PoseTarget{robot.forward().pose(q)}}, options);
    } else {
      script.add(PtpMove{JointTarget{q}}, options);
    }
    if (random() % 6 == 0) {
      script.add(SetOutput{static_cast<int>(random() % 8), random() % 2 == 0});
    }
    if (random() % 16 == 0) script.add(Wait{0.05});
  }
  return script.program();
}

/// A script, an arm in virtual time, and what happens between them.
struct Cell {
  explicit Cell(const MotionProgram& of, double margin = kMargin)
      : arm_robot(robot("puma560")),
        program(of),
        loop(std::make_unique<SimulatedDrive>(of.start), arm_robot->limits()) {
    MotionProgram beginning = program;
    beginning.steps.clear();
    stream = std::make_unique<MotionStream>(
        arm_robot, beginning,
        [this](std::shared_ptr<const Trajectory> first) {
          handed.chunks.emplace_back(0.0, *first);
          job = loop.follow(std::move(first));
          return std::make_shared<Recorder>(job, handed);
        },
        margin);
  }
  /// Tells a step when there are few enough before it.
  void tell(const Step& step, int ahead) {
    while (stream->steps_ahead() >= ahead && !ended()) pass(1);
    stream->add(step);
  }
  /// So many cycles, or until the arm waits or rests in a pause.
  void pass(int cycles) {
    for (int k = 0; k < cycles; ++k) {
      loop.pass(1);
      stream->hand_over();
    }
  }
  [[nodiscard]] bool ended() const { return job != nullptr && !loop.busy(); }
  void finish() {
    stream->end();
    for (int k = 0; k < 1'000'000 && !ended(); ++k) pass(1);
    ASSERT_TRUE(ended());
  }
  [[nodiscard]] std::vector<TrajectoryPiece> whole() const {
    return MotionPlanner(arm_robot).plan(program).trajectory.pieces();
  }

  RobotPtr arm_robot;
  MotionProgram program;
  VirtualLoop loop;
  Handed handed;
  std::shared_ptr<OpenJob> job;  ///< once it has begun
  std::unique_ptr<MotionStream> stream;
};

/// How far a run's setpoints are from the way that its chunks tell, at the same nominal times.
double off_chunks(const std::vector<LogRecord>& log, const Handed& handed) {
  double worst = 0.0, begin = 0.0;
  std::size_t at = 0;
  for (const LogRecord& record : log) {
    while (at + 1 < handed.chunks.size() &&
           record.nominal_time >= begin + handed.chunks[at + 1].first) {
      begin += handed.chunks[++at].first;
    }
    const JointVector q = handed.chunks[at].second.at(record.nominal_time - begin).q;
    worst = std::max(worst, (q - record.q).cwiseAbs().maxCoeff());
  }
  return worst;
}

bool ends_at(const JointVector& q, const std::vector<TrajectoryPiece>& whole) {
  return q.isApprox(whole.back().at(whole.back().duration).q, 1e-12);
}

TEST(MotionStream, RunsExactlyWhatItWasHanded) {
  for (unsigned seed = 0; seed < problems(20U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Cell cell(some_moves(*robot("puma560"), 30, random));
    for (const Step& step : cell.program.steps) cell.tell(step, 16);
    cell.finish();
    const auto& job = cell.job;
    ASSERT_EQ(job->state(), RunState::kFinished) << cell.loop.fault();
    const std::vector<LogRecord> log = job->log();
    EXPECT_LE(off_chunks(log, cell.handed), 1e-12);
    EXPECT_NEAR(log.back().nominal_time, job->duration(), kCycle);
    const std::vector<TrajectoryPiece> whole = cell.whole();
    EXPECT_TRUE(ends_at(log.back().q, whole));
    EXPECT_EQ(cell.stream->late_count(), 0U) << cell.stream->late().front().source.line;
    EXPECT_EQ(job->waited_cycles(), 0U);
  }
}

TEST(MotionStream, RestsOnThePathForAStepThatComesLateAndSaysWhich) {
  std::mt19937 random(7);
  Script script(*robot("puma560"), puma_a());
  const Zone zone{ZoneKind::kJointDeviation, 0.05};
  script.movej(puma_b(), zone).movej(puma_c(), zone).movej(puma_a(), zone);
  script.movej(puma_c(), zone).movej(puma_b(), zone);
  Cell cell(script.program());
  for (const Step& step : cell.program.steps) {
    cell.tell(step, 100);
    if (step.source.line != 3) continue;
    cell.pass(5'000);  // the script thinks, until the arm rests
    ASSERT_EQ(cell.job->state(), RunState::kWaiting);
  }
  cell.finish();
  ASSERT_EQ(cell.job->state(), RunState::kFinished) << cell.loop.fault();
  ASSERT_EQ(cell.stream->late_count(), 1U);
  EXPECT_EQ(cell.stream->late().front().source.line, 4);
  EXPECT_EQ(cell.stream->late().front().step, 3);
  EXPECT_GT(cell.stream->late().front().waited_cycles, 0U);
  const std::vector<LogRecord> log = cell.job->log();
  EXPECT_LE(off_chunks(log, cell.handed), 1e-12);
  EXPECT_LE(off_path(told(cell.handed), cell.whole()), 1e-12);
  const auto waits = std::ranges::count(log, RunState::kWaiting, &LogRecord::state);
  EXPECT_EQ(waits, 2) << "a rest leaves its first two cycles";
  EXPECT_TRUE(log.back().q.isApprox(puma_b(), 1e-12));
}

TEST(MotionStream, GoesOnFromRestWhereAChunkIsHandedOverTooLate) {
  int missed = 0;
  for (unsigned seed = 0; seed < problems(16U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Cell cell(some_moves(*robot("puma560"), 12, random), -1.0);
    const std::vector<TrajectoryPiece> whole = cell.whole();
    for (const Step& step : cell.program.steps) {
      cell.tell(step, 100);
      cell.pass(static_cast<int>(random() % 150));
    }
    cell.finish();
    ASSERT_EQ(cell.job->state(), RunState::kFinished) << cell.loop.fault();
    const std::vector<LogRecord> log = cell.job->log();
    ASSERT_LE(off_chunks(log, cell.handed), 1e-12);
    ASSERT_TRUE(ends_at(log.back().q, whole));
    ASSERT_EQ(log.back().outputs, [&] {
      std::uint64_t on = 0;
      for (const auto& [index, value] : changes_of(whole)) {
        const std::uint64_t bit = std::uint64_t{1} << index;
        on = value ? on | bit : on & ~bit;
      }
      return on;
    }());
    missed += static_cast<int>(cell.stream->late_count());
  }
  EXPECT_GE(missed, problems(17)) << "the margin was to be too small";
}

TEST(MotionStream, HoldsEveryCommandWhateverComesAndWhen) {
  std::array<int, 11> seen{};
  for (unsigned seed = 0; seed < problems(24U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Cell cell(some_moves(*robot("puma560"), 25, random));
    const std::vector<TrajectoryPiece> whole = cell.whole();
    const auto disturb = [&] {
      const auto& job = cell.job;
      for (int k = static_cast<int>(random() % 8 == 0 ? 500 : random() % 60); k > 0; --k) {
        cell.pass(1);
        if (job == nullptr) continue;
        ++seen[static_cast<std::size_t>(job->state())];
        switch (random() % 60) {
          case 0:
            cell.loop.set_override(0.01 * static_cast<double>(random() % 101));
            break;
          case 1:
            job->pause();
            break;
          case 2:
            job->backward();
            break;
          case 3:
            job->step();
            break;
          case 4:
          case 5:
          case 6:
            job->resume();
            break;
          case 7:
            if (job->state() == RunState::kPaused) {
              try {
                cell.loop.jog(JointVector::Constant(6, 0.02));
              } catch (const MotionError& error) {
                ASSERT_EQ(error.code(), ErrorCode::kBusy);
              }
            }
            break;
          default:
            break;
        }
      }
    };
    for (const Step& step : cell.program.steps) {
      disturb();
      cell.stream->add(step);
      if (cell.job != nullptr && random() % 2 == 0) cell.job->resume();
    }
    cell.loop.set_override(1.0);
    cell.job->resume();
    cell.finish();
    ASSERT_EQ(cell.job->state(), RunState::kFinished) << cell.loop.fault();
    const std::vector<LogRecord> log = cell.job->log();
    ASSERT_TRUE(ends_at(log.back().q, whole));
  }
  for (const RunState state : {RunState::kRunning, RunState::kPausing, RunState::kPaused,
                               RunState::kJogging, RunState::kReturning, RunState::kWaiting}) {
    EXPECT_GT(seen[static_cast<std::size_t>(state)], 0) << to_string(state);
  }
}

TEST(MotionStream, SwitchesOutputsBeforeTheEndOfTheMoveThatTheyAreToldWith) {
  const RobotPtr puma = robot("puma560");
  JointVector home(6);
  home << 0.0, -0.8, 0.6, 0.0, 1.0, 0.0;
  const Eigen::Isometry3d here = puma->forward().pose(home);
  Eigen::Isometry3d there = here;
  there.translation().x() -= 0.1;
  constexpr int kMoves = 40;
  Script script(*puma, home);
  for (int k = 0; k < kMoves; ++k) {
    script.add(LinMove{PoseTarget{k % 2 == 0 ? there : here}}, {});
    script.add(SetOutput{3, k % 2 == 0, -0.02});
  }
  for (const int ahead : {4, 16}) {
    SCOPED_TRACE(ahead);
    Cell cell(script.program());
    for (const Step& step : cell.program.steps) {
      if (std::holds_alternative<SetOutput>(step.what)) {
        cell.stream->add(step);
      } else {
        cell.tell(step, ahead);
      }
    }
    cell.finish();
    int changes = 0;
    const std::vector<LogRecord> log = cell.job->log();
    for (std::size_t k = 1; k < log.size(); ++k) {
      if (log[k].outputs == log[k - 1].outputs) continue;
      const Eigen::Vector3d goal = (changes++ % 2 == 0 ? there : here).translation();
      const double before = (puma->forward().pose(log[k - 1].q).translation() - goal).norm();
      const double at = (puma->forward().pose(log[k].q).translation() - goal).norm();
      EXPECT_GE(before, 0.02 - 1e-6);
      EXPECT_LE(at, 0.02 + 1e-6);
    }
    EXPECT_EQ(changes, kMoves);
  }
}

TEST(MotionStream, StopsOnThePathAndTakesNoMore) {
  std::mt19937 random(3);
  Cell cell(some_moves(*robot("puma560"), 20, random));
  for (std::size_t k = 0; k < 6; ++k) cell.tell(cell.program.steps[k], 100);
  cell.pass(50);
  cell.job->stop(StopCategory::kHold);
  cell.tell(cell.program.steps[6], 100);
  cell.pass(5'000);
  EXPECT_EQ(cell.job->state(), RunState::kStopped);
  cell.stream->hand_over();
  EXPECT_LE(off_chunks(cell.job->log(), cell.handed), 1e-12);
}

TEST(MotionStream, RunsTheStepsBeforeOneThatIsRefused) {
  Script script(*robot("puma560"), puma_a());
  script.movej(puma_b()).movej(JointVector::Constant(6, 100.0)).movej(puma_c());
  Cell cell(script.program());
  cell.tell(cell.program.steps[0], 100);
  try {
    cell.stream->add(cell.program.steps[1]);
    ADD_FAILURE() << "it was to be refused";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kJointLimit);
    EXPECT_EQ(error.problem().line, 2);
  }
  EXPECT_THROW(cell.stream->add(cell.program.steps[2]), MotionError);
  cell.finish();
  EXPECT_EQ(cell.job->state(), RunState::kFinished);
  EXPECT_TRUE(cell.job->log().back().q.isApprox(puma_b(), 1e-12));
}

TEST(MotionStream, MovesNothingMoreOnceTheArmHasRefusedAMotion) {
  Script script(*robot("puma560"), puma_a());
  script.movej(puma_b()).add(Wait{0.1});
  script.movej(puma_a());
  Cell cell(script.program());
  int calls = 0;
  MotionProgram beginning = cell.program;
  beginning.steps.clear();
  const auto refuse_first = [&](std::shared_ptr<const Trajectory> first) {
    if (++calls == 1) throw MotionError(ErrorCode::kBusy, "the arm is in use");
    return cell.loop.follow(std::move(first));
  };
  MotionStream stream(cell.arm_robot, beginning, refuse_first, kMargin);
  for (const Step& step : cell.program.steps) stream.add(step);
  const auto code_of = [](const auto& call) {
    try {
      call();
    } catch (const MotionError& error) {
      return error.code();
    }
    return ErrorCode::kInternal;
  };
  EXPECT_EQ(code_of([&] { stream.hand_over(); }), ErrorCode::kBusy);
  EXPECT_EQ(code_of([&] { stream.hand_over(); }), ErrorCode::kBusy);
  EXPECT_EQ(code_of([&] { stream.add(cell.program.steps.front()); }), ErrorCode::kBusy);
  EXPECT_EQ(code_of([&] { stream.end(); }), ErrorCode::kBusy);
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(stream.run(), nullptr);
}

TEST(MotionStream, OfNothingMovesNothing) {
  Script script(*robot("puma560"), puma_a());
  Cell cell(script.program());
  cell.stream->end();
  cell.stream->hand_over();
  EXPECT_EQ(cell.stream->run(), nullptr);
}

}  // namespace
}  // namespace viapoint
