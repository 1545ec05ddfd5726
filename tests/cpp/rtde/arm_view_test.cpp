#include "rtde/arm_view.hpp"

#include <gtest/gtest.h>

#include <random>

#include "rtde/rtde_fixture.hpp"
#include "rtde/variables.hpp"

namespace viapoint::rtde {
namespace {

constexpr std::int64_t kCycle = 2'000'000, kSecond = 1'000'000'000;

JointVector random_joints(std::mt19937_64& random) {
  JointVector q(6);
  for (double& angle : q) angle = std::uniform_real_distribution(-3.0, 3.0)(random);
  return q;
}

/// The pose that position and rotation vector say.
Pose pose_of(const Vector6& place) {
  const Eigen::Vector3d turn = place.tail<3>();
  Pose pose = Pose::Identity();
  pose.translation() = place.head<3>();
  if (turn.norm() > 0.0) {
    pose.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  }
  return pose;
}

std::uint32_t number(const char* name, const ArmView& view) {
  Bytes bytes;
  find_output(name)->write(view, bytes);
  std::string_view rest = bytes;
  return take<std::uint32_t>(rest);
}

TEST(RtdeArmView, TellsToolAndSpeedsOfSetpointAndMeasurement) {
  const ForwardKinematics arm = six_axes();
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    ArmWatch watch(arm, 0.002, 0);
    ShownArm shown;
    LoopCycle& cycle = shown.cycle;
    const auto apart = static_cast<std::int64_t>(1 + random() % 3);
    const JointVector step = 1e-4 * random_joints(random);
    const JointVector before = random_joints(random);
    cycle.cycle = 7;
    cycle.stamp = 10 * kCycle;
    cycle.measurement.q = before;
    (void)watch.see(cycle, cycle.stamp);
    cycle.cycle += static_cast<std::uint64_t>(apart);
    cycle.stamp += apart * kCycle;
    cycle.measurement.q = before + step;
    cycle.q = random_joints(random);
    cycle.qd = random_joints(random);
    const ArmView view = watch.see(cycle, cycle.stamp + kCycle / 4);

    EXPECT_DOUBLE_EQ(view.time, 1e-9 * static_cast<double>(cycle.stamp));
    const double rate = 1.0 / (0.002 * static_cast<double>(apart));
    EXPECT_LT((view.actual_qd - rate * step).norm(), 1e-9);
    EXPECT_LT((pose_of(view.target_tool).matrix() - arm.pose(cycle.q).matrix()).norm(), 1e-9);
    EXPECT_LT((pose_of(view.actual_tool).matrix() - arm.pose(before + step).matrix()).norm(), 1e-9);
    // The tool's speed by differences of its pose.
    constexpr double kStep = 1e-6;
    const Pose ahead = arm.pose(cycle.q + kStep * cycle.qd);
    const Pose behind = arm.pose(cycle.q - kStep * cycle.qd);
    const Eigen::Vector3d speed = (ahead.translation() - behind.translation()) / (2.0 * kStep);
    const Eigen::AngleAxisd turn(ahead.rotation() * behind.rotation().transpose());
    EXPECT_LT((view.target_tool_speed.head<3>() - speed).norm(), 1e-6);
    EXPECT_LT(
        (view.target_tool_speed.tail<3>() - turn.angle() * turn.axis() / (2.0 * kStep)).norm(),
        1e-5);
  }
}

TEST(RtdeArmView, TellsNoSpeedAcrossALoopThatWasBuiltAnew) {
  ArmWatch watch(six_axes(), 0.002, 0);
  ShownArm shown;
  shown.cycle.cycle = 5000;
  (void)watch.see(shown.cycle, 0);
  shown.cycle.cycle = 1;
  shown.cycle.measurement.q.setConstant(0.5);
  EXPECT_EQ(watch.see(shown.cycle, 0).actual_qd.norm(), 0.0);
}

TEST(RtdeArmView, SaysFaultAndLostPowerWhileTimeGoesOn) {
  ArmWatch watch(six_axes(), 0.002, 0);
  ShownArm shown;
  LoopCycle& cycle = shown.cycle;
  cycle.stamp = kSecond;
  cycle.cycle = 500;
  cycle.state = RunState::kRunning;
  cycle.qd.setConstant(0.1);
  ArmView view = watch.see(cycle, kSecond);
  EXPECT_EQ(number("robot_mode", view), 7U);
  EXPECT_EQ(number("safety_mode", view), 1U);
  EXPECT_EQ(number("safety_status_bits", view), 1U);
  EXPECT_EQ(number("robot_status_bits", view), 3U);
  EXPECT_EQ(number("joint_mode", view), 253U);

  cycle.state = RunState::kFault;
  view = watch.see(cycle, 3 * kSecond);
  EXPECT_EQ(view.time, 3.0);
  EXPECT_EQ(number("robot_mode", view), 7U);
  EXPECT_EQ(number("safety_mode", view), 3U);
  EXPECT_EQ(number("safety_status_bits", view), (1U << 2) | (1U << 10));
  EXPECT_EQ(number("robot_status_bits", view), 1U);
  EXPECT_EQ(number("joint_mode", view), 252U);
  EXPECT_EQ(view.cycle.qd.norm(), 0.0);

  cycle.state = RunState::kStopped;  // released: no cycle comes any more
  view = watch.see(cycle, 4 * kSecond);
  EXPECT_EQ(number("robot_mode", view), 3U);
  EXPECT_EQ(number("robot_status_bits", view), 0U);
  EXPECT_EQ(number("joint_mode", view), 239U);
}

TEST(RtdeArmView, SaysWhatTheProgramDoes) {
  ArmView view;
  for (const auto& [state, runtime] : {std::pair{RunState::kStopping, 0U},
                                       {RunState::kStopped, 1U},
                                       {RunState::kIdle, 1U},
                                       {RunState::kFinished, 1U},
                                       {RunState::kJogging, 1U},
                                       {RunState::kFault, 1U},
                                       {RunState::kRunning, 2U},
                                       {RunState::kWaiting, 2U},
                                       {RunState::kPausing, 3U},
                                       {RunState::kPaused, 4U},
                                       {RunState::kReturning, 5U}}) {
    view.cycle.state = state;
    EXPECT_EQ(number("runtime_state", view), runtime) << to_string(state);
  }
}

TEST(RtdeVariables, KnowsFortyEightRegistersOfEachKindAndNoOther) {
  EXPECT_NE(find_output("output_int_register_0"), nullptr);
  EXPECT_NE(find_output("output_double_register_47"), nullptr);
  EXPECT_NE(find_input("input_double_register_47"), nullptr);
  for (const char* const name :
       {"output_int_register_48", "output_int_register_", "output_int_register_-1",
        "output_int_register_1x", "output_double_register_99999999999", "", "timestam"}) {
    EXPECT_EQ(find_output(name), nullptr) << name;
  }
  EXPECT_EQ(find_input("output_int_register_1"), nullptr);
}

}  // namespace
}  // namespace viapoint::rtde
