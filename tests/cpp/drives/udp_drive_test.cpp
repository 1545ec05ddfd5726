#include "viapoint/drives/udp_drive.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <future>
#include <limits>

#include "drives/udp_device.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/virtual_loop.hpp"

namespace viapoint {
namespace {

constexpr int kJoints = 2;

struct Link {
  UdpDevice device{kJoints};
  std::shared_ptr<UdpTraffic> traffic = std::make_shared<UdpTraffic>();
  UdpDrive drive;
  JointVector stands = JointVector::Constant(kJoints, 0.25);

  explicit Link(int patience = 2000)
      : drive({"127.0.0.1", device.port(), kJoints, std::chrono::milliseconds(patience)}, traffic) {
  }

  udp::Answer answer_to(const udp::Command& command) const {
    udp::Answer answer;
    answer.condition = udp::Condition::kFollowing;
    answer.sequence = command.sequence;
    answer.stamp = command.stamp;
    answer.q = stands;
    return answer;
  }
  Measurement enable() {
    auto measured = std::async(std::launch::async, [this] { return drive.enable(); });
    const udp::Command asked = device.take_command();
    EXPECT_EQ(asked.order, udp::Order::kEnable);
    device.send(answer_to(asked));
    return measured.get();
  }
  /// Of a cycle in which the device answers at once: the answer is taken in the next.
  DriveStatus cycle(double q, Measurement& measurement) {
    Setpoint setpoint;
    setpoint.q = JointVector::Constant(kJoints, q);
    setpoint.qd = JointVector::Constant(kJoints, 2.0 * q);
    setpoint.outputs = 3;
    return drive.exchange(setpoint, measurement);
  }
};

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const MotionError& error) {
    return error.problem().message;
  }
  return {};
}

TEST(UdpDrive, TellsSetpointsAndTakesTheAnswerToTheCycleBefore) {
  Link link;
  EXPECT_EQ(link.enable().q, link.stands);
  Measurement measurement;
  EXPECT_EQ(link.cycle(0.1, measurement), DriveStatus::kSilent);
  udp::Command command = link.device.take_command();
  while (command.order == udp::Order::kEnable) command = link.device.take_command();
  EXPECT_EQ(command.order, udp::Order::kFollow);
  EXPECT_EQ(command.q, JointVector::Constant(kJoints, 0.1));
  EXPECT_EQ(command.qd, JointVector::Constant(kJoints, 0.2));
  EXPECT_EQ(command.outputs, 3U);
  EXPECT_GT(command.stamp, 0);
  link.stands.setConstant(0.5);
  udp::Answer answer = link.answer_to(command);
  answer.inputs = 9;
  link.device.send(answer);
  EXPECT_EQ(link.cycle(0.2, measurement), DriveStatus::kOk);
  EXPECT_EQ(measurement.q, JointVector::Constant(kJoints, 0.5));
  EXPECT_EQ(measurement.inputs, 9U);
  EXPECT_EQ(link.device.take_command().sequence, command.sequence + 1);
}

TEST(UdpDrive, TakesTheNewestOfSeveralAnswers) {
  Link link;
  link.enable();
  Measurement measurement;
  for (const double q : {0.1, 0.2, 0.3})
    EXPECT_EQ(link.cycle(q, measurement), DriveStatus::kSilent);
  for (int answered = 0; answered < 3;) {
    const udp::Command command = link.device.take_command();
    if (command.order == udp::Order::kEnable) continue;
    link.stands = command.q;
    link.device.send(link.answer_to(command));
    ++answered;
  }
  EXPECT_EQ(link.cycle(0.4, measurement), DriveStatus::kOk);
  EXPECT_EQ(measurement.q, JointVector::Constant(kJoints, 0.3));
  EXPECT_EQ(link.cycle(0.4, measurement), DriveStatus::kSilent);
}

TEST(UdpDrive, IgnoresAndCountsWhatIsNoAnswerToIt) {
  Link link;
  link.enable();
  Measurement measurement;
  EXPECT_EQ(link.cycle(0.1, measurement), DriveStatus::kSilent);
  udp::Command command = link.device.take_command();
  while (command.order == udp::Order::kEnable) command = link.device.take_command();

  const udp::Answer good = link.answer_to(command);
  udp::Datagram datagram{};
  const std::size_t size = udp::encode(good, datagram);
  const auto send_changed = [&](std::size_t byte, std::uint8_t value, std::size_t length) {
    udp::Datagram changed = datagram;
    changed[byte] = value;
    link.device.send(std::span<const std::uint8_t>(changed.data(), length));
  };
  send_changed(0, 'X', size);
  send_changed(4, 9, size);
  send_changed(6, 7, size);
  send_changed(4, 1, size - 1);
  link.device.send(std::span<const std::uint8_t>());
  udp::Answer early = good;
  early.sequence = command.sequence + 100;  // nobody has asked that yet
  link.device.send(early);
  udp::Answer old = good;
  old.sequence = 1;  // answered by enable()
  link.device.send(old);
  const std::uint64_t old_before = link.traffic->old;
  EXPECT_EQ(link.cycle(0.1, measurement), DriveStatus::kSilent);
  EXPECT_EQ(link.traffic->wrong_magic, 1U);
  EXPECT_EQ(link.traffic->wrong_version, 1U);
  EXPECT_EQ(link.traffic->wrong_joints, 1U);
  EXPECT_EQ(link.traffic->wrong_size, 2U);
  EXPECT_EQ(link.traffic->old, old_before + 2);

  link.device.send(good);
  EXPECT_EQ(link.cycle(0.1, measurement), DriveStatus::kOk);
  link.device.send(good);  // twice
  EXPECT_EQ(link.cycle(0.1, measurement), DriveStatus::kSilent);
  EXPECT_EQ(link.traffic->old, old_before + 3);
  EXPECT_EQ(link.traffic->silent, 3U);
}

TEST(UdpDrive, TakesNoAnswerWhoseJointsAreNoNumbers) {
  Link link;
  link.enable();
  Measurement measurement;
  measurement.q = JointVector::Constant(kJoints, 0.3);
  EXPECT_EQ(link.cycle(0.1, measurement), DriveStatus::kSilent);
  udp::Command command = link.device.take_command();
  while (command.order == udp::Order::kEnable) command = link.device.take_command();
  udp::Answer answer = link.answer_to(command);
  answer.q[kJoints - 1] = std::numeric_limits<double>::quiet_NaN();
  link.device.send(answer);
  EXPECT_EQ(link.cycle(0.1, measurement), DriveStatus::kSilent);
  EXPECT_EQ(measurement.q, JointVector::Constant(kJoints, 0.3));
  EXPECT_EQ(link.traffic->not_finite, 1U);
}

TEST(UdpDrive, TellsWhatTheDeviceSaysOfItself) {
  using udp::Condition;
  const std::vector<std::pair<Condition, DriveStatus>> all{
      {Condition::kFollowing, DriveStatus::kOk},  {Condition::kGuided, DriveStatus::kGuided},
      {Condition::kFault, DriveStatus::kFault},   {Condition::kPowerLost, DriveStatus::kPowerLost},
      {Condition::kOff, DriveStatus::kPowerLost}, {static_cast<Condition>(77), DriveStatus::kFault},
  };
  Link link;
  link.enable();
  Measurement measurement;
  for (const auto& [condition, status] : all) {
    EXPECT_EQ(link.cycle(0.0, measurement), DriveStatus::kSilent);
    udp::Command command = link.device.take_command();
    while (command.order == udp::Order::kEnable) command = link.device.take_command();
    udp::Answer answer = link.answer_to(command);
    answer.condition = condition;
    answer.fault_code = 31;
    link.device.send(answer);
    EXPECT_EQ(link.cycle(0.0, measurement), status);
    if (status == DriveStatus::kFault || status == DriveStatus::kPowerLost) {
      EXPECT_FALSE(link.drive.fault().empty());
    }
    if (condition == Condition::kFault) {
      EXPECT_EQ(link.drive.fault(), "the device reports a fault (code 31)");
    }
    link.device.take_command();
  }
}

TEST(UdpDrive, ReleasesTheDevice) {
  Link link;
  link.enable();
  link.drive.release();
  udp::Command command = link.device.take_command();
  while (command.order == udp::Order::kEnable) command = link.device.take_command();
  EXPECT_EQ(command.order, udp::Order::kRelease);
}

TEST(UdpDrive, IsRefusedByADeviceThatDoesNotAnswerOrHasAFault) {
  {
    Link link(50);
    const std::string said = message_of([&] { link.drive.enable(); });
    EXPECT_NE(said.find("no device has answered within 50 ms"), std::string::npos) << said;
  }
  {
    Link link;
    auto measured =
        std::async(std::launch::async, [&] { return message_of([&] { link.drive.enable(); }); });
    udp::Answer answer = link.answer_to(link.device.take_command());
    answer.condition = udp::Condition::kFault;
    answer.fault_code = 12;
    link.device.send(answer);
    EXPECT_EQ(measured.get(), "the device reports a fault (code 12)");
  }
  {
    Link link(200);
    auto measured =
        std::async(std::launch::async, [&] { return message_of([&] { link.drive.enable(); }); });
    udp::Answer answer = link.answer_to(link.device.take_command());
    answer.q = JointVector::Zero(3);
    link.device.send(answer);
    const std::string said = measured.get();
    EXPECT_NE(said.find("1 answers were for another number of joints"), std::string::npos) << said;
  }
}

TEST(UdpDrive, RefusesWhatIsNoAddress) {
  const auto refused = [](UdpDriveOptions options) {
    return message_of([&] { UdpDrive{std::move(options)}; });
  };
  EXPECT_NE(refused({"localhost", 7500, 2}).find("no address in numbers"), std::string::npos);
  EXPECT_NE(refused({"127.0.0.1", 0, 2}).find("port is 0"), std::string::npos);
  EXPECT_NE(refused({"127.0.0.1", 70000, 2}).find("port is 70000"), std::string::npos);
  EXPECT_NE(refused({"127.0.0.1", 7500, 17}).find("not 17"), std::string::npos);
}

TEST(UdpDrive, ExchangesWithoutTheHeap) {
  Link link;
  link.enable();
  Measurement measurement;
  measurement.q = JointVector::Zero(kJoints);
  Setpoint setpoint;
  setpoint.q = setpoint.qd = JointVector::Zero(kJoints);
  udp::Command command = (link.cycle(0.0, measurement), link.device.take_command());
  while (command.order == udp::Order::kEnable) command = link.device.take_command();
  link.device.send(link.answer_to(command));
  const NoAllocationScope scope;
  const DriveStatus status = link.drive.exchange(setpoint, measurement);
  const DriveStatus silent = link.drive.exchange(setpoint, measurement);
  const std::uint64_t calls = scope.calls();
  EXPECT_EQ(calls, 0U);
  EXPECT_EQ(status, DriveStatus::kOk);
  EXPECT_EQ(silent, DriveStatus::kSilent);
}

/// A loop in virtual time over a device that answers every cycle until it is told not to.
struct Loop {
  std::unique_ptr<Link> link = std::make_unique<Link>();
  JointLimits limits;
  std::unique_ptr<VirtualLoop> loop;

  Loop() {
    limits.velocity = JointVector::Constant(kJoints, 2.0);
    limits.acceleration = JointVector::Constant(kJoints, 20.0);
    limits.jerk = JointVector::Constant(kJoints, 200.0);
    limits.position_max = JointVector::Constant(kJoints, 10.0);
    limits.position_min = -limits.position_max;
    auto drive = std::make_unique<UdpDrive>(UdpDriveOptions{
        "127.0.0.1", link->device.port(), kJoints, std::chrono::milliseconds(2000)});
    auto made = std::async(std::launch::async, [&] {
      return std::make_unique<VirtualLoop>(std::move(drive), limits, LoopOptions{});
    });
    link->device.send(link->answer_to(link->device.take_command()));
    loop = made.get();
  }
  void cycle(const JointVector* answer) {
    loop->pass(1);
    udp::Command command = link->device.take_command();
    while (command.order == udp::Order::kEnable) command = link->device.take_command();
    if (answer == nullptr) return;
    link->stands = *answer;
    link->device.send(link->answer_to(command));
  }
};

TEST(UdpDrive, IsADriveFaultAfterTenSilentCycles) {
  Loop cell;
  const JointVector q = cell.link->stands;
  for (int k = 0; k < 20; ++k) cell.cycle(&q);
  EXPECT_EQ(cell.loop->fault(), "");
  for (int k = 0; k < 10; ++k) cell.cycle(nullptr);
  EXPECT_EQ(cell.loop->fault(), "");
  // One more answer was on its way, and the fault comes once the arm rests.
  for (int k = 0; k < 4; ++k) cell.loop->pass(1);
  EXPECT_NE(cell.loop->fault().find("the drive has not answered for 11 cycles"), std::string::npos)
      << cell.loop->fault();
}

TEST(UdpDrive, IsGuardedAgainstEncodersThatJump) {
  Loop cell;
  JointVector q = cell.link->stands;
  for (int k = 0; k < 5; ++k) cell.cycle(&q);
  q[1] += 0.4;
  for (int k = 0; k < 4; ++k) cell.cycle(&q);
  EXPECT_NE(cell.loop->fault().find("joint 2 was measured to jump"), std::string::npos)
      << cell.loop->fault();
}

TEST(UdpDrive, IsSilentWhileItsEncodersReadNoNumber) {
  Loop cell;
  const JointVector q = cell.link->stands;
  JointVector none = q;
  none[1] = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < 5; ++k) cell.cycle(&q);
  for (int k = 0; k < 10; ++k) cell.cycle(&none);
  for (int k = 0; k < 5; ++k) cell.cycle(&q);
  EXPECT_EQ(cell.loop->fault(), "");
  EXPECT_EQ(cell.loop->measured().q, q);
  for (int k = 0; k < 14; ++k) cell.cycle(&none);
  EXPECT_NE(cell.loop->fault().find("the drive has not answered for 11 cycles"), std::string::npos)
      << cell.loop->fault();
  EXPECT_EQ(cell.loop->measured().q, q);
}

}  // namespace
}  // namespace viapoint
