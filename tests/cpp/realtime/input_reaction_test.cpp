// Runs that pause, go on and stop by themselves when the drive reports an input.
#include "viapoint/realtime/input_reaction.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/virtual_loop.hpp"

namespace viapoint {
namespace {

const JointLimits kLimits = even_limits(2, 2.0, 20.0, 200.0);

struct Cell {
  Cell() {
    std::vector<TrajectoryPiece> pieces;
    append_straight(pieces, JointVector::Zero(2), JointVector::Constant(2, 4.0), kLimits, 0);
    trajectory = std::make_shared<Trajectory>(std::move(pieces), kLimits);
    job = loop.run(trajectory);
  }
  std::shared_ptr<std::atomic<std::uint64_t>> inputs =
      std::make_shared<std::atomic<std::uint64_t>>(0);
  VirtualLoop loop{std::make_unique<SimulatedDrive>(JointVector::Zero(2), inputs), kLimits};
  std::shared_ptr<const Trajectory> trajectory;
  std::shared_ptr<Job> job;
};

TEST(InputReaction, PausesInTheCycleAfterTheInputAndKeepsThePath) {
  Cell cell;
  cell.job->on_input({3, true, Wish::kPause});
  cell.job->on_input({3, false, Wish::kRun});
  cell.loop.pass(200);
  EXPECT_EQ(cell.job->state(), RunState::kRunning) << "an input that is off resumes what runs";
  cell.job->on_input({3, false, Wish::kRun});
  cell.job->on_input({});  // takes the pause back
  *cell.inputs = 1U << 3;
  cell.loop.pass(50);
  EXPECT_EQ(cell.job->state(), RunState::kRunning);
  *cell.inputs = 0;
  cell.loop.pass(1);
  cell.job->on_input({5, true, Wish::kPause});
  *cell.inputs = 1U << 5;
  cell.loop.pass(1);  // the drive reports it
  EXPECT_EQ(cell.job->state(), RunState::kRunning);
  cell.loop.pass(1);
  EXPECT_EQ(cell.job->state(), RunState::kPausing);
  cell.loop.pass(10'000);
  EXPECT_EQ(cell.job->state(), RunState::kPaused);
  cell.job->on_input({5, false, Wish::kRun});
  cell.loop.pass(10);
  EXPECT_EQ(cell.job->state(), RunState::kPaused);
  *cell.inputs = 0;
  cell.loop.pass(1);
  cell.loop.pass(10'000);
  EXPECT_EQ(cell.job->state(), RunState::kFinished);
  for (const LogRecord& record : cell.job->log()) {
    ASSERT_TRUE(record.q.isApprox(cell.trajectory->at(record.nominal_time).q, 1e-12));
  }
}

TEST(InputReaction, ActsOnce) {
  Cell cell;
  *cell.inputs = 1;
  cell.job->on_input({0, true, Wish::kPause});
  cell.loop.pass(3);
  cell.loop.pass(10'000);
  ASSERT_EQ(cell.job->state(), RunState::kPaused);
  cell.job->resume();
  cell.loop.pass(10'000);
  EXPECT_EQ(cell.job->state(), RunState::kFinished);
}

TEST(InputReaction, StopsForGoodAndLeavesAStopAlone) {
  Cell cell;
  cell.job->on_input({63, true, Wish::kStop});
  cell.job->on_input({62, true, Wish::kRun});
  cell.loop.pass(100);
  *cell.inputs = ~std::uint64_t{0};
  cell.loop.pass(10'000);
  EXPECT_EQ(cell.job->state(), RunState::kStopped);
  EXPECT_LT(cell.job->nominal_time(), cell.trajectory->duration());
}

TEST(InputReaction, TheSaferOfOneCycleCounts) {
  Cell cell;
  cell.job->on_input({1, true, Wish::kRun});
  cell.job->on_input({2, true, Wish::kPause});
  *cell.inputs = 0b110;
  cell.loop.pass(10'000);
  EXPECT_EQ(cell.job->state(), RunState::kPaused) << "one input resumes, another pauses";

  *cell.inputs = 0;
  cell.loop.pass(2);
  cell.job->resume();
  cell.job->on_input({1, true, Wish::kStop});
  cell.job->on_input({2, true, Wish::kPause});
  cell.job->on_input({3, true, Wish::kRun});
  cell.loop.pass(50);
  ASSERT_EQ(cell.job->state(), RunState::kRunning);
  *cell.inputs = 0b1110;
  cell.loop.pass(10'000);
  EXPECT_EQ(cell.job->state(), RunState::kStopped);
}

TEST(InputReaction, DoesNotResumeWhatIsPausedInTheSameCycle) {
  Cell cell;
  cell.loop.pass(50);
  cell.job->on_input({4, true, Wish::kRun});
  *cell.inputs = 1U << 4;
  cell.loop.pass(1);  // the drive reports it: the next cycle acts
  cell.job->pause();
  cell.loop.pass(10'000);
  EXPECT_EQ(cell.job->state(), RunState::kPaused);
}

TEST(InputReaction, IsRefusedWhereItMeansNothing) {
  Cell cell;
  EXPECT_THROW(cell.job->on_input({64, true, Wish::kPause}), MotionError);
  EXPECT_THROW(cell.job->on_input({-2, true, Wish::kPause}), MotionError);
  EXPECT_THROW(cell.job->on_input({1, true, Wish::kBackward}), MotionError);
}

}  // namespace
}  // namespace viapoint
