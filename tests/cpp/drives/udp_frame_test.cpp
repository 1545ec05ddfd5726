#include "viapoint/drives/udp_frame.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace viapoint {
namespace {

using udp::Flaw;

udp::Command some_command() {
  udp::Command command;
  command.order = udp::Order::kFollow;
  command.sequence = 0x0102030405060708;
  command.stamp = -2;
  command.outputs = 5;
  command.q = JointVector::Constant(2, 1.0);
  command.qd = JointVector::Constant(2, -0.5);
  return command;
}

TEST(UdpFrame, LaysACommandOutAsItIsDocumented) {
  udp::Datagram datagram{};
  ASSERT_EQ(udp::encode(some_command(), datagram), 64U);
  const std::array<std::uint8_t, 40> expected{'V', 'P', 'S', 'P', 1, 2, 2, 0, 8, 7, 6, 5, 4, 3, 2,
                                              1, 0xfe, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 5,
                                              0, 0, 0, 0, 0, 0, 0,
                                              // 1.0
                                              0, 0, 0, 0, 0, 0, 0xf0, 0x3f};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(datagram[i], expected[i]) << i;
}

TEST(UdpFrame, ReadsWhatItWrote) {
  udp::Datagram datagram{};
  const std::size_t size = udp::encode(some_command(), datagram);
  udp::Command read;
  ASSERT_EQ(udp::decode({datagram.data(), size}, 2, read), Flaw::kNone);
  EXPECT_EQ(read.sequence, 0x0102030405060708U);
  EXPECT_EQ(read.stamp, -2);
  EXPECT_EQ(read.outputs, 5U);
  EXPECT_EQ(read.q, JointVector::Constant(2, 1.0));
  EXPECT_EQ(read.qd, JointVector::Constant(2, -0.5));

  udp::Answer answer;
  answer.condition = udp::Condition::kGuided;
  answer.sequence = 7;
  answer.stamp = 9;
  answer.inputs = 1ULL << 63;
  answer.fault_code = 0xdeadbeef;
  answer.q = JointVector::LinSpaced(kMaxJoints, -1.0, 1.0);
  const std::size_t length = udp::encode(answer, datagram);
  EXPECT_EQ(length, 40U + 8U * kMaxJoints);
  udp::Answer back;
  ASSERT_EQ(udp::decode({datagram.data(), length}, kMaxJoints, back), Flaw::kNone);
  EXPECT_EQ(back.condition, udp::Condition::kGuided);
  EXPECT_EQ(back.inputs, 1ULL << 63);
  EXPECT_EQ(back.fault_code, 0xdeadbeef);
  EXPECT_EQ(back.q, answer.q);
}

TEST(UdpFrame, NamesWhatIsWrong) {
  udp::Datagram datagram{};
  udp::Answer answer, read;
  answer.q = JointVector::Zero(2);
  const std::size_t size = udp::encode(answer, datagram);
  const auto flaw = [&](std::size_t length) {
    return udp::decode({datagram.data(), length}, 2, read);
  };
  EXPECT_EQ(flaw(size), Flaw::kNone);
  EXPECT_EQ(flaw(size - 1), Flaw::kSize);
  EXPECT_EQ(flaw(size + 1), Flaw::kSize);
  EXPECT_EQ(flaw(0), Flaw::kSize);
  EXPECT_EQ(flaw(7), Flaw::kSize);
  EXPECT_EQ(udp::decode({datagram.data(), size}, 3, read), Flaw::kJoints);
  datagram[4] = 2;
  EXPECT_EQ(flaw(size), Flaw::kVersion);
  datagram[0] = 'X';
  EXPECT_EQ(flaw(size), Flaw::kMagic);
  udp::Command command;
  EXPECT_EQ(udp::decode({datagram.data(), size}, 2, command), Flaw::kMagic);
}

TEST(UdpFrame, TakesNoNumberThatIsNotFinite) {
  udp::Datagram datagram{};
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (const Eigen::Index joint : {0, 1}) {
      udp::Answer answer;
      answer.q = JointVector::Zero(2);
      answer.q[joint] = bad;
      std::size_t size = udp::encode(answer, datagram);
      EXPECT_EQ(udp::decode({datagram.data(), size}, 2, answer), Flaw::kNotFinite) << bad;

      for (JointVector udp::Command::* values : {&udp::Command::q, &udp::Command::qd}) {
        udp::Command command = some_command();
        (command.*values)[joint] = bad;
        size = udp::encode(command, datagram);
        EXPECT_EQ(udp::decode({datagram.data(), size}, 2, command), Flaw::kNotFinite) << bad;
      }
    }
  }
}

TEST(UdpFrame, ReadsAnyBytesWithoutHarm) {
  std::mt19937_64 random(11);
  udp::Datagram datagram{};
  int taken = 0;
  for (int k = 0; k < 100'000; ++k) {
    udp::Answer answer;
    answer.q = JointVector::Zero(6);
    std::size_t size = udp::encode(answer, datagram);
    const int changes = static_cast<int>(random() % 4);
    for (int c = 0; c < changes; ++c) {
      datagram[random() % size] = static_cast<std::uint8_t>(random());
    }
    if (random() % 2 == 0) size = random() % datagram.size();
    taken += udp::decode({datagram.data(), size}, 6, answer) == Flaw::kNone ? 1 : 0;
    if (size < 8) continue;
    EXPECT_TRUE(answer.q.size() == 6);
  }
  EXPECT_GT(taken, 10'000);
  EXPECT_LT(taken, 60'000);
}

}  // namespace
}  // namespace viapoint
