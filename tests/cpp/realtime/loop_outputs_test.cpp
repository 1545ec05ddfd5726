#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "realtime/random_motion.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {
namespace {

using std::chrono::steady_clock;

const JointLimits kLimits = even_limits(2, 2.0, 20.0, 200.0);

/// There and back; output 1 goes on with the first move, 2 on and 1 off with the second.
std::shared_ptr<const Trajectory> switching_motion() {
  std::vector<TrajectoryPiece> pieces;
  const JointVector here = JointVector::Zero(2), there = JointVector::Constant(2, 0.5);
  append_straight(pieces, here, there, kLimits, 0);
  const std::size_t second = pieces.size();
  append_straight(pieces, there, -there, kLimits, 1);
  pieces.front().output[0] = {1, true};
  pieces.front().outputs = 1;
  pieces[second].output[0] = {1, false};
  pieces[second].output[1] = {2, true};
  pieces[second].outputs = 2;
  return std::make_shared<Trajectory>(std::move(pieces), kLimits);
}

class LoopOutputs : public testing::Test {
 public:
  /// True once the loop has sent these outputs.
  bool sent(std::uint64_t outputs) {
    return comes_true([&] { return loop.newest_cycle().outputs == outputs; });
  }
  static bool comes_true(const std::function<bool()>& holds) {
    const auto deadline = steady_clock::now() + std::chrono::seconds(20);
    while (!holds()) {
      if (steady_clock::now() > deadline) return false;
      std::this_thread::yield();
    }
    return true;
  }

  ControllerLoop loop{std::make_unique<SimulatedDrive>(JointVector::Zero(2)), kLimits,
                      LoopOptions{}, std::make_unique<VirtualClock>()};
};

TEST_F(LoopOutputs, AreSwitchedByHandAtRest) {
  loop.switch_outputs(0b1010, 0b1111);
  EXPECT_TRUE(sent(0b1010));
  loop.switch_outputs(0b0011, 0b0001);
  EXPECT_TRUE(sent(0b1001));
}

TEST_F(LoopOutputs, StayAsTheyWereSwitchedLastByHandOrByTheMotion) {
  loop.switch_outputs(0b10001, 0b10001);
  ASSERT_TRUE(sent(0b10001));
  loop.set_override(1e-2);  // or it is over before anybody looks
  const auto job = loop.run(switching_motion());
  ASSERT_TRUE(comes_true([&] { return job->nominal_time() > 0.02; }));
  job->pause();
  ASSERT_TRUE(comes_true([&] { return job->state() == RunState::kPaused; }));
  ASSERT_EQ(job->move(), 0);
  EXPECT_EQ(loop.newest_cycle().outputs, 0b10011U) << "those by hand stay, the motion's is on";
  loop.switch_outputs(0b00011, 0b00000);
  EXPECT_TRUE(sent(0b10000));
  loop.set_override(1.0);
  job->resume();
  ASSERT_TRUE(job->wait(60.0));
  EXPECT_EQ(loop.newest_cycle().outputs, 0b10100U);
  const std::vector<LogRecord> log = job->log();
  EXPECT_EQ(log.front().outputs, 0b10011U);
  EXPECT_EQ(log.back().outputs, 0b10100U);
  for (std::size_t k = 1; k < log.size(); ++k) {
    // The motion switches output 2 with its second move, and nothing else is switched there.
    const bool begins_second = log[k].move == 1 && log[k - 1].move == 0;
    const std::uint64_t changed = log[k].outputs ^ log[k - 1].outputs;
    if (begins_second) {
      EXPECT_EQ(changed, 0b100U);
    } else {
      EXPECT_EQ(changed & 0b100U, 0U);
    }
  }
}

TEST_F(LoopOutputs, AreTakenOverByTheNextMotionAsTheyAre) {
  ASSERT_TRUE(loop.run(switching_motion())->wait(60.0));
  EXPECT_EQ(loop.newest_cycle().outputs, 0b100U);
  loop.switch_outputs(0b100, 0);
  ASSERT_TRUE(sent(0));
  ASSERT_TRUE(loop.run(switching_motion())->wait(60.0));
  EXPECT_EQ(loop.newest_cycle().outputs, 0b100U) << "switched on again, though it was on before";
}

TEST_F(LoopOutputs, AreShownWithTheRestOfTheNewestCycle) {
  const LoopCycle before = loop.newest_cycle();
  EXPECT_EQ(before.q.size(), 2);
  loop.set_override(1e-3);  // or it is over before anybody looks
  const auto job = loop.run(switching_motion());
  ASSERT_TRUE(comes_true([&] { return loop.newest_cycle().qd.norm() > 0.0; }));
  const LoopCycle under_way = loop.newest_cycle();
  EXPECT_GT(under_way.cycle, before.cycle);
  EXPECT_GT(under_way.stamp, before.stamp);
  EXPECT_EQ(under_way.override_share, 1e-3);
  loop.set_override(1.0);
  ASSERT_TRUE(job->wait(60.0));
  const LogRecord last = job->log().back();
  const LoopCycle after = loop.newest_cycle();
  EXPECT_EQ(after.q, last.q);
  EXPECT_EQ(after.measurement.q, last.q);
  EXPECT_EQ(after.state, RunState::kFinished);
  EXPECT_EQ(after.qd.norm(), 0.0);
}

}  // namespace
}  // namespace viapoint
