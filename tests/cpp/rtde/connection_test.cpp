#include "rtde/connection.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <optional>
#include <string>

#include "rtde/rtde_fixture.hpp"

namespace viapoint::rtde {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr double kCycle = 0.002;

/// A connection whose other end and whose time are the test's.
class RtdeConnection : public testing::Test {
 public:
  RtdeConnection() {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()), 0);
    client = Descriptor(ends[0]);
    connection.emplace(Descriptor(ends[1]), arm, kCycle, 0);
    view.cycle = arm.cycle;
  }
  void say(std::string_view bytes) {
    ASSERT_EQ(send_some(client, bytes), std::optional(bytes.size()));
    connection->read();
  }
  /// All that has come to the client.
  std::string heard() {
    std::string all;
    std::array<char, 4096> some{};
    while (const auto count = receive_some(client, some)) {
      if (*count == 0) break;
      all.append(some.data(), *count);
    }
    return all;
  }

  ShownArm arm;
  ArmView view;
  Descriptor client;
  std::optional<Connection> connection;
};

TEST_F(RtdeConnection, EndsWhenNothingIsSaidForFiveSeconds) {
  EXPECT_FALSE(connection->is_over(5 * kSecond));
  EXPECT_TRUE(connection->is_over(5 * kSecond + 1));
}

TEST_F(RtdeConnection, EndsWhenAGreetingStaysHalf) {
  say(greeting().substr(0, 4));
  EXPECT_FALSE(connection->is_over(5 * kSecond));
  EXPECT_TRUE(connection->is_over(5 * kSecond + 1));
}

TEST_F(RtdeConnection, StaysWithAClientThatGreetsAndOnlyTells) {
  say(greeting());
  connection->send(kSecond);
  EXPECT_FALSE(connection->is_over(86'400 * kSecond));
}

TEST_F(RtdeConnection, EndsWhenWhatItSendsIsNotReadForThirtySeconds) {
  say(greeting() + output_setup(500.0, "timestamp,actual_q") + package(PackageType::kStart, ""));
  std::int64_t now = kSecond;
  connection->send(now);
  // Until the system keeps no more for the client.
  int sent = 0;
  for (; !connection->has_to_send() && sent < 1'000'000; ++sent) {
    view.time += kCycle;
    connection->show(view);
    connection->send(now);
  }
  ASSERT_TRUE(connection->has_to_send());
  EXPECT_FALSE(connection->is_over(now + 30 * kSecond));
  EXPECT_TRUE(connection->is_over(now + 30 * kSecond + 1));
  // It reads at last: everything is whole and in order.
  now += 30 * kSecond;
  std::string all = heard();
  connection->send(now);
  EXPECT_FALSE(connection->is_over(now + 30 * kSecond));
  all += heard();
  const auto packages = packages_in(all);
  ASSERT_TRUE(packages.has_value());
  EXPECT_EQ(packages->size(), static_cast<std::size_t>(sent) + 3U);  // the answers to V, O and S
}

TEST_F(RtdeConnection, EndsOnceAClientThatBreaksTheProtocolHasBeenToldWhy) {
  say("GET / HTTP/1.1\r\n\r\n");
  EXPECT_FALSE(connection->is_over(0));
  connection->send(0);
  EXPECT_TRUE(connection->is_over(0));
  const auto packages = packages_in(heard());
  ASSERT_TRUE(packages && packages->size() == 1);
  EXPECT_EQ(packages->front().type, 'M');
}

TEST_F(RtdeConnection, EndsWhenTheClientHasGone) {
  say(greeting());
  client = Descriptor();
  connection->read();
  EXPECT_TRUE(connection->is_over(0));
}

}  // namespace
}  // namespace viapoint::rtde
