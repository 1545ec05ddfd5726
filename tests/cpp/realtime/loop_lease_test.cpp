#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "realtime/random_motion.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

const JointLimits kLimits = even_limits(2, 2.0, 20.0, 200.0);

std::shared_ptr<const Trajectory> move_to(double end) {
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(2), JointVector::Constant(2, end), kLimits, 0);
  return std::make_shared<Trajectory>(std::move(pieces), kLimits);
}

std::unique_ptr<ControllerLoop> loop_of(std::unique_ptr<Clock> clock) {
  return std::make_unique<ControllerLoop>(std::make_unique<SimulatedDrive>(JointVector::Zero(2)),
                                          kLimits, LoopOptions{}, std::move(clock));
}

[[nodiscard]] bool await(const std::function<bool()>& holds) {
  const auto deadline = steady_clock::now() + seconds(60);
  while (!holds()) {
    if (steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return true;
}

TEST(LoopLease, ARunPausesByItselfWhenTheLeaseIsOverAndGoesOnOnlyWhenToldTo) {
  const auto loop = loop_of(std::make_unique<VirtualClock>());
  loop->keep_alive(nanoseconds::zero());
  const auto job = loop->run(move_to(3.0));
  ASSERT_TRUE(await([&] { return job->state() == RunState::kPaused; }));
  EXPECT_LT(job->nominal_time(), job->duration());
  // More than any log on its way holds: the loop has seen the wish long before.
  constexpr std::uint64_t kMany = 100'000;
  const std::uint64_t before = job->report().rested_cycles;
  job->resume();  // nobody is there
  ASSERT_TRUE(await([&] { return job->report().rested_cycles > before + kMany; }));
  EXPECT_EQ(job->state(), RunState::kPaused);

  loop->keep_alive(std::chrono::hours(1));
  const std::uint64_t rested = job->report().rested_cycles;
  ASSERT_TRUE(await([&] { return job->report().rested_cycles > rested + 100; }));
  EXPECT_EQ(job->state(), RunState::kPaused);
  job->resume();
  EXPECT_TRUE(job->wait(60.0));
  EXPECT_EQ(job->state(), RunState::kFinished);
}

TEST(LoopLease, AnEarlierRunPausesOnItsWay) {
  const auto loop = loop_of(std::make_unique<MonotonicClock>());
  const auto job = loop->run(move_to(6.0));
  ASSERT_TRUE(await([&] { return job->nominal_time() > 0.1; }));
  loop->keep_alive(milliseconds(10));
  ASSERT_TRUE(await([&] { return job->state() == RunState::kPaused; }));
  for (const LogRecord& record : job->log()) EXPECT_LE(record.qdd.cwiseAbs().maxCoeff(), 20.00002);
  job->stop();  // a stop is heard always
  EXPECT_TRUE(job->wait(60.0));
  EXPECT_EQ(job->state(), RunState::kStopped);
}

TEST(LoopLease, AJogEndsWithTheLease) {
  const auto loop = loop_of(std::make_unique<MonotonicClock>());
  loop->keep_alive(milliseconds(30));
  ASSERT_TRUE(await([&] {
    loop->jog(JointVector::Constant(2, 0.05));
    return loop->position()[0] > 0.0;
  }));
  loop->keep_alive(nanoseconds::zero());
  EXPECT_TRUE(await([&] { return !loop->jogging(); }));
}

}  // namespace
}  // namespace viapoint
