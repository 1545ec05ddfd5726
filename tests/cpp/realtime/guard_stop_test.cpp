// What the loop does with a setpoint that must not pass: motions that are changed after they were
// admitted, as a mistake anywhere before the guard would do it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/virtual_loop.hpp"

namespace viapoint {
namespace {

constexpr double kCycle = 2e-3;
constexpr double kSlack = 1.0 + 1e-6;
constexpr int kPatience = 10'000;

JointLimits held_limits() {
  JointLimits limits = even_limits(2, 2.0, 10.0, 200.0);
  limits.position_max.setConstant(3.0);
  return limits;
}

Trajectory straight(double step, const JointLimits& limits) {
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(2), JointVector::Constant(2, step), limits, 0);
  return {std::move(pieces), limits};
}

/// A motion with `damage` done to the pieces of its second half, where it is at speed.
template <typename Damage>
Trajectory damaged(const Damage& damage) {
  const JointLimits limits = held_limits();
  std::vector<TrajectoryPiece> pieces = straight(2.5, limits).pieces();
  for (std::size_t k = pieces.size() / 2; k < pieces.size(); ++k) damage(pieces[k]);
  return {std::move(pieces), limits};
}

struct Mistake {
  const char* name;
  Trajectory motion;
  const char* says;
};

std::vector<Mistake> mistakes() {
  constexpr double kMost = std::numeric_limits<double>::max();  // twice that is infinite
  return {
      {"velocity", straight(2.5, even_limits(2, 4.0, 10.0, 200.0)), "move too fast"},
      {"acceleration", straight(2.5, even_limits(2, 2.0, 20.0, 200.0)), "accelerate too much"},
      {"jerk", straight(2.5, even_limits(2, 2.0, 10.0, 400.0)), "change its acceleration too fast"},
      {"position", straight(3.5, held_limits()), "leave its position limits"},
      {"no number",
       damaged([](TrajectoryPiece& piece) { piece.path[0][0] = piece.path[1][0] = kMost; }),
       "not a number"},
      {"a jump", damaged([](TrajectoryPiece& piece) { piece.path[0][1] += 0.1; }),
       "joint 2 was told to move too fast"},
      {"a small jump", damaged([](TrajectoryPiece& piece) { piece.path[0][1] -= 1e-5; }),
       "joint 2 was told a velocity that does not belong"},
  };
}

/// What the drive was told: every limit, from one setpoint to the next, and rest at the end.
void expect_stop_within_limits(const std::vector<LogRecord>& log, const JointLimits& limits) {
  const auto within = [](const JointVector& step, const JointVector& most) {
    return (step.cwiseAbs().array() <= kSlack * most.array()).all();
  };
  for (std::size_t k = 1; k < log.size(); ++k) {
    ASSERT_TRUE(log[k].q.allFinite()) << "cycle " << k;
    ASSERT_TRUE(within((log[k].q - log[k - 1].q) / kCycle, limits.velocity)) << "cycle " << k;
    ASSERT_TRUE(within((log[k].qd - log[k - 1].qd) / kCycle, limits.acceleration)) << "cycle " << k;
    // A stop that ends without acceleration goes on this much farther than the shortest.
    const double more = 10.0 * 10.0 * 10.0 / (24.0 * 200.0 * 200.0);
    ASSERT_LE(log[k].q.maxCoeff(), limits.position_max.minCoeff() + more) << "cycle " << k;
    ASSERT_TRUE(within((log[k].qdd - log[k - 1].qdd) / kCycle, limits.jerk)) << "cycle " << k;
  }
  ASSERT_FALSE(log.empty());
  EXPECT_TRUE(log.back().qd.isZero(0.0));
}

std::string fault_of(Job& job) {
  try {
    static_cast<void>(job.wait(0.0));
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kDriveFault);
    return error.problem().message;
  }
  ADD_FAILURE() << "the run did not fail";
  return {};
}

TEST(GuardStop, NamesEveryMistakeAndStopsEachJointWithinItsLimits) {
  const JointLimits limits = held_limits();
  for (const Mistake& mistake : mistakes()) {
    SCOPED_TRACE(mistake.name);
    VirtualLoop loop(std::make_unique<SimulatedDrive>(JointVector::Zero(2)), limits);
    const auto motion = std::make_shared<Trajectory>(straight(2.5, limits));
    for (int k = 0; k < ControllerLoop::kFaultCycles; ++k) loop.pass(1);
    const auto job = loop.run(motion);
    *motion = mistake.motion;  // proven, and not begun
    for (int k = 0; k < kPatience && loop.busy(); ++k) loop.pass(1);
    ASSERT_EQ(job->state(), RunState::kFault);
    const std::string fault = fault_of(*job);
    EXPECT_NE(fault.find(mistake.says), std::string::npos) << fault;
    EXPECT_NE(fault.find("stopped off its path"), std::string::npos) << fault;
    EXPECT_EQ(loop.fault(), fault);
    const std::vector<LogRecord> log = job->log();
    expect_stop_within_limits(log, limits);
    // A jerk is broken by the first setpoint that moves.
    const auto stops = [](const LogRecord& r) {
      return r.state == RunState::kStopping && !r.qd.isZero();
    };
    EXPECT_EQ(std::ranges::any_of(log, stops), std::string(mistake.name) != "jerk");
    const std::vector<LogRecord> last = loop.fault_cycles();
    ASSERT_EQ(last.size(), static_cast<std::size_t>(ControllerLoop::kFaultCycles));
    EXPECT_EQ(last.back().state, RunState::kFault);
    EXPECT_EQ(last.back().cycle, log.back().cycle);
    EXPECT_EQ(last.back().q, log.back().q);
  }
}

/// A tool of 1 m that the first joint turns about z.
ForwardKinematics lever() {
  ChainJoint joint;
  Pose tool = Pose::Identity();
  tool.translation() << 1.0, 0.0, 0.0;
  return ForwardKinematics(std::array{joint}, tool);
}

TEST(GuardStop, HoldsThePathForTheToolAndForTheDrive) {
  const JointLimits limits = even_limits(1, 2.0, 20.0, 200.0);
  struct Case {
    const char* says;
    void (*set)(GuardOptions& guard, SimulatedDriveOptions& drive);
  };
  const std::vector<Case> cases = {
      {"the tool was told to move too fast",
       [](GuardOptions& guard, SimulatedDriveOptions&) { guard.tool_speed = 0.25; }},
      {"the tool left its box along y",
       [](GuardOptions& guard, SimulatedDriveOptions&) { guard.box_max.y() = 0.5; }},
      {"joint 1 is too far from its setpoint",
       [](GuardOptions&, SimulatedDriveOptions& drive) { drive.lag = 2.0; }},
  };
  for (const Case& of : cases) {
    SCOPED_TRACE(of.says);
    LoopOptions options;
    options.guard.kinematics = lever();
    SimulatedDriveOptions drive;
    of.set(options.guard, drive);
    VirtualLoop loop(std::make_unique<SimulatedDrive>(JointVector::Zero(1), nullptr, drive), limits,
                     options);
    std::vector<TrajectoryPiece> pieces;
    append_straight(pieces, JointVector::Zero(1), JointVector::Constant(1, 2.5), limits, 0);
    const auto motion = std::make_shared<Trajectory>(std::move(pieces), limits);
    const auto job = loop.run(motion);
    for (int k = 0; k < kPatience && loop.busy(); ++k) loop.pass(1);
    ASSERT_EQ(job->state(), RunState::kFault);
    const std::string fault = fault_of(*job);
    EXPECT_NE(fault.find(of.says), std::string::npos) << fault;
    EXPECT_NE(fault.find("stopped on its path"), std::string::npos) << fault;
    expect_stop_within_limits(job->log(), limits);
    for (const LogRecord& record : job->log()) {
      ASSERT_EQ(record.q, motion->at(record.nominal_time).q);
    }
    EXPECT_LT(job->nominal_time(), motion->duration());
    EXPECT_EQ(loop.fault_cycles().size(), static_cast<std::size_t>(ControllerLoop::kFaultCycles));
  }
}

TEST(GuardStop, OfAJogLeavesItsCyclesToo) {
  const JointLimits limits = even_limits(1, 2.0, 20.0, 200.0);
  LoopOptions options;
  options.guard.kinematics = lever();
  options.guard.tool_speed = 0.25;
  VirtualLoop loop(std::make_unique<SimulatedDrive>(JointVector::Zero(1)), limits, options);
  loop.jog(JointVector::Constant(1, 1.0));
  for (int k = 0; k < kPatience && loop.fault().empty(); ++k) loop.pass(1);
  EXPECT_EQ(loop.newest_cycle().state, RunState::kFault);
  EXPECT_NE(loop.fault().find("the tool was told to move too fast"), std::string::npos)
      << loop.fault();
  const std::vector<LogRecord> last = loop.fault_cycles();
  ASSERT_FALSE(last.empty());
  expect_stop_within_limits(last, limits);
}

}  // namespace
}  // namespace viapoint
