// A long shift in virtual time: programs and streams one after the other on one loop, and somebody
// who presses everything there is, at random. What the drive is told is judged in every cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "planning/planner_fixture.hpp"
#include "planning/random_program.hpp"
#include "problem_count.hpp"
#include "streaming/handed.hpp"
#include "streaming/soak_judge.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/virtual_loop.hpp"
#include "viapoint/streaming/motion_stream.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;

constexpr double kCycle = 2e-3;
constexpr int kInputs = 4;
/// Of one run, with commands; then it is let go to its end.
constexpr int kCommanded = 3000;
/// A run that has not ended so many cycles after its last command will not.
constexpr int kPatience = 60'000;

/// Between the loop and the simulated arm.
class WatchedDrive final : public Drive {
 public:
  WatchedDrive(const JointVector& start, std::shared_ptr<Setpoint> told,
               std::shared_ptr<std::atomic<std::uint64_t>> inputs)
      : arm_(start, std::move(inputs)), told_(std::move(told)) {}
  [[nodiscard]] int joints() const override { return arm_.joints(); }
  Measurement enable() override { return arm_.enable(); }
  DriveStatus exchange(const Setpoint& setpoint, Measurement& measurement) noexcept override {
    *told_ = setpoint;
    return arm_.exchange(setpoint, measurement);
  }
  void release() noexcept override { arm_.release(); }

 private:
  SimulatedDrive arm_;
  std::shared_ptr<Setpoint> told_;
};

/// One arm, and who works at it.
class Shift {
 public:
  Shift(const std::string& name, unsigned seed, const StateTable& table)
      : random_(seed), robot_(robot(name)), judge_(robot_->limits(), kCycle, table) {
    const JointLimits& limits = robot_->limits();
    range_ = (0.5 * (limits.position_max - limits.position_min)).cwiseMin(1.5);
    // Not in the middle itself, where arms are stretched out.
    middle_ = 0.5 * (limits.position_min + limits.position_max) + 0.25 * range_;
    loop_ = std::make_unique<VirtualLoop>(std::make_unique<WatchedDrive>(middle_, told_, inputs_),
                                          robot_->limits());
  }

  /// Until so many cycles have passed, or something is wrong.
  void work(std::uint64_t cycles) {
    while (judge_.cycles() < cycles && judge_.problem().empty() && !::testing::Test::HasFailure()) {
      if (chance(0.3)) jog_between_runs();
      chance(0.4) ? run_stream() : run_program();
    }
  }

  [[nodiscard]] const SoakJudge& judge() const { return judge_; }
  [[nodiscard]] int finished() const { return finished_; }
  [[nodiscard]] int stopped() const { return stopped_; }

 private:
  double uniform(double low = -1.0, double high = 1.0) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
  int whole(int below) { return std::uniform_int_distribution<int>(0, below - 1)(random_); }

  /// Moves of every kind from where the arm rests; those that cannot be had are left out.
  MotionProgram some_program() {
    Script script(*robot_, loop_->position());
    for (int k = 2 + whole(14); k > 0; --k) {
      JointVector q = middle_;
      for (Eigen::Index i = 0; i < q.size(); ++i) q[i] += 0.2 * range_[i] * uniform();
      MoveOptions options;
      if (!chance(0.2)) options.zone = {ZoneKind::kJointDeviation, 0.03};
      if (chance(0.1)) options.scale = uniform(0.05, 1.0);
      const Pose end = robot_->forward().pose(q);
      switch (whole(6)) {
        case 0:
          script.add(LinMove{PoseTarget{end}}, options);
          break;
        case 1: {
          Pose via = end;
          via.translation() += 0.05 * Eigen::Vector3d(uniform(), uniform(), uniform());
          script.add(CircMove{PositionTarget{via.translation()}, PoseTarget{end}}, options);
          break;
        }
        default:
          script.add(PtpMove{JointTarget{q}}, options);
      }
      if (chance(0.2)) script.add(SetOutput{whole(8), chance(0.5)});
      if (chance(0.1)) script.add(Wait{0.1 * uniform(0.0, 1.0)});
    }
    MotionProgram program = script.program();
    while (leave_out_errors(program, MotionPlanner(robot_).check(program))) {
    }
    return program;
  }

  void run_program() {
    const MotionProgram program = some_program();
    if (program.steps.empty()) return;
    const auto planned =
        std::make_shared<Trajectory>(MotionPlanner(robot_).plan(program).trajectory);
    const std::shared_ptr<Job> job = loop_->run(planned);
    int left = kCommanded;
    const auto pass = [&] { cycle(job.get()); };
    while (loop_->busy() && left-- > 0) {
      press(*job);
      pass();
    }
    let_go(*job);
    for (int k = 0; k < kPatience && loop_->busy(); ++k) pass();
    end_run({planned.get(), 1}, *job);
  }

  void run_stream() {
    const MotionProgram program = some_program();
    MotionProgram beginning = program;
    beginning.steps.clear();
    Handed handed;
    std::shared_ptr<OpenJob> begun;
    MotionStream stream(
        robot_, beginning,
        [&](std::shared_ptr<const Trajectory> first) {
          handed.chunks.emplace_back(0.0, *first);
          begun = loop_->follow(std::move(first));
          return std::make_shared<Recorder>(begun, handed);
        },
        2 * kCycle);
    const auto pass = [&](bool press_too) {
      Job* const job = begun.get();
      if (job != nullptr && press_too) press(*job);
      cycle(job, [&] {
        stream.hand_over();
        return handed.chunks.empty() ? 0 : handed.chunks.size() - 1;
      });
    };
    for (const Step& step : program.steps) {
      // Most come in time, some late.
      for (int k = chance(0.15) ? 500 : whole(100); k > 0; --k) pass(true);
      stream.add(step);
    }
    stream.end();
    pass(false);
    if (begun == nullptr) return;
    for (int k = 0; k < kCommanded && loop_->busy(); ++k) pass(true);
    let_go(*begun);
    for (int k = 0; k < kPatience && loop_->busy(); ++k) pass(false);
    end_run(ways(handed), *begun);
  }

  /// Whatever an operator can do in a cycle; mostly nothing.
  void press(Job& job) {
    if (!chance(0.02)) return;
    switch (whole(16)) {
      case 0:
      case 1:
      case 2:
        return loop_->set_override(chance(0.3) ? 1.0 : chance(0.2) ? 0.0 : uniform(0.0, 1.0));
      case 3:
      case 4:
        return job.pause();
      case 5:
        return job.step();
      case 6:
        return job.backward();
      case 7:
      case 8:
        return jog_in_a_pause(job);
      case 9:
        inputs_->fetch_xor(std::uint64_t{1} << whole(kInputs));
        return;
      case 10:
        return job.on_input({static_cast<std::int16_t>(whole(kInputs)), chance(0.5), Wish::kPause});
      case 11:
        return job.on_input({static_cast<std::int16_t>(whole(kInputs)), chance(0.5), Wish::kRun});
      case 12:
        if (!chance(0.15)) return;
        stop_told_ = true;
        return chance(0.5) ? job.stop()
                           : job.on_input({static_cast<std::int16_t>(whole(kInputs)), chance(0.5),
                                           Wish::kStop});
      default:
        return job.resume();
    }
  }

  void jog_in_a_pause(Job& job) {
    if (job.state() == RunState::kPaused) job.pause();  // a step's end is no wish to pause
    try {
      loop_->jog(some_velocity());
    } catch (const MotionError& error) {
      ASSERT_EQ(error.code(), ErrorCode::kBusy) << error.what();
    }
  }

  void jog_between_runs() {
    for (int k = 1 + whole(4); k > 0; --k) {
      loop_->jog(some_velocity());
      for (int c = whole(200); c > 0; --c) cycle(nullptr);
    }
    rest();
  }

  void rest() {
    for (int k = 0; k < kPatience && loop_->jogging(); ++k) cycle(nullptr);
    ASSERT_FALSE(loop_->jogging()) << "a jog without end";
  }

  JointVector some_velocity() {
    JointVector velocity = robot_->limits().velocity;
    for (double& value : velocity) value *= 0.2 * uniform();
    return velocity;
  }

  /// @param way what the run follows in this cycle, called after it
  void cycle(
      const Job* job, const std::function<std::size_t()>& way = [] { return std::size_t{0}; }) {
    const bool runs = job != nullptr && loop_->busy();
    loop_->pass(1);
    const std::size_t followed = way();
    if (runs) {
      judge_.see(*told_, job->state(), SoakJudge::Progress{job->nominal_time(), followed});
    } else {
      judge_.see(*told_, loop_->jogging() ? RunState::kJogging : RunState::kIdle, std::nullopt);
    }
  }

  void let_go(Job& job) {
    for (const Wish wish : {Wish::kPause, Wish::kRun, Wish::kStop}) job.on_input({-1, true, wish});
    loop_->set_override(1.0);
    job.resume();
  }

  void end_run(std::span<const Trajectory> ways, const Job& job) {
    ASSERT_FALSE(loop_->busy()) << "a run is " << to_string(job.state()) << " for ever";
    ASSERT_EQ(loop_->fault(), "");
    judge_.judge_run(ways, job.log(), stop_told_);
    ++(job.state() == RunState::kFinished ? finished_ : stopped_);
    stop_told_ = false;
    rest();  // from a jog that was wished with the stop
  }

  std::mt19937 random_;
  RobotPtr robot_;
  SoakJudge judge_;
  JointVector middle_, range_;  ///< of the joints
  std::shared_ptr<Setpoint> told_ = std::make_shared<Setpoint>();
  std::shared_ptr<std::atomic<std::uint64_t>> inputs_ =
      std::make_shared<std::atomic<std::uint64_t>>(0);
  std::unique_ptr<VirtualLoop> loop_;
  bool stop_told_ = false;  ///< in the run under way
  int finished_ = 0, stopped_ = 0;
};

/// Of each arm: 10^6 cycles of four.
constexpr unsigned kSeeds = 2;

class Soak : public ::testing::TestWithParam<std::string> {};

TEST_P(Soak, HoldsLimitsPathStatesAndEndsWhateverIsPressed) {
  const StateTable table(std::string(VIAPOINT_TEST_DATA) + "/../../docs/realtime.md");
  ASSERT_GT(table.arrows().size(), 20U) << "the diagram is gone, or looks otherwise";
  constexpr std::uint64_t kCycles = problems(125'000U);
  double worst = 0.0;
  int finished = 0, stopped = 0;
  std::map<RunState, std::uint64_t> seen;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(GetParam() + ", seed " + std::to_string(seed));
    Shift shift(GetParam(), seed, table);
    shift.work(kCycles);
    ASSERT_EQ(shift.judge().problem(), "");
    ASSERT_FALSE(HasFailure());
    worst = std::max(worst, shift.judge().worst_share());
    finished += shift.finished();
    stopped += shift.stopped();
    for (int s = 0; s <= static_cast<int>(RunState::kWaiting); ++s) {
      const auto state = static_cast<RunState>(s);
      seen[state] += shift.judge().seen(state);
    }
  }
  EXPECT_GT(worst, 0.9) << "the limits were never near: the test shows nothing";
  EXPECT_GT(finished, problems(10));
  EXPECT_GE(stopped, problems(2));
  if (kCycles < 125'000U) return;  // too few to have met everything
  for (const auto& [state, count] : seen) {
    EXPECT_EQ(count > 0, state != RunState::kFault) << to_string(state);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, Soak, ::testing::Values("puma560", "ur5e", "scara", "panda"),
                         [](const auto& robot) { return robot.param; });

}  // namespace
}  // namespace viapoint
