#include "viapoint/rtde/rtde_server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "rtde/rtde_fixture.hpp"
#include "rtde/socket.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint::rtde {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

constexpr std::int64_t kCycle = 2'000'000;

/// An arm whose loop would have done one cycle every 2 ms, and each measured its own number.
class TickingArm final : public RtdeArm {
 public:
  [[nodiscard]] LoopCycle newest_cycle() override {
    LoopCycle cycle = shown_.cycle;
    const std::int64_t now = nanoseconds(steady_clock::now().time_since_epoch()).count();
    cycle.cycle = static_cast<std::uint64_t>(now / kCycle);
    cycle.stamp = now / kCycle * kCycle;
    cycle.measurement.q[0] = 0.002 * static_cast<double>(cycle.cycle);
    return cycle;
  }
  void set_override(double share) override { override_share = share; }
  void switch_outputs(std::uint64_t mask, std::uint64_t values) override {
    outputs = mask & values;
  }

  std::atomic<double> override_share{1.0};
  std::atomic<std::uint64_t> outputs{0};

 private:
  ShownArm shown_;
};

/// A client that waits at most some seconds for anything.
class Client {
 public:
  explicit Client(int port, int receive_buffer = 0)
      : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval patience{10, 0};
    setsockopt(socket_.number(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (receive_buffer > 0) {
      setsockopt(socket_.number(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    sockaddr_in where{};
    where.sin_family = AF_INET;
    where.sin_port = htons(static_cast<std::uint16_t>(port));
    where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    // The socket interface of the system.
    const auto* const any = reinterpret_cast<const sockaddr*>(&where);
    is_connected_ = connect(socket_.number(), any, sizeof where) == 0;
  }

  [[nodiscard]] bool is_connected() const { return is_connected_; }
  void send(std::string_view bytes) {
    EXPECT_EQ(send_some(socket_, bytes), std::optional(bytes.size()));
  }
  /// nullopt where the server has closed the connection.
  [[nodiscard]] std::optional<Package> next() {
    Bytes header, payload;
    if (!read(header, kHeaderBytes)) return std::nullopt;
    std::string_view rest = header;
    const std::size_t length = take<std::uint16_t>(rest);
    if (!read(payload, length - kHeaderBytes)) return std::nullopt;
    return Package{rest[0], payload};
  }
  /// Greets, and begins to be sent these.
  void start(double hertz, std::string_view names) {
    send(greeting() + output_setup(hertz, names) + package(PackageType::kStart, ""));
    for (const char type : {'V', 'O', 'S'}) EXPECT_EQ(next().value_or(Package{}).type, type);
  }

 private:
  [[nodiscard]] bool read(Bytes& into, std::size_t count) {
    into.resize(count);
    std::size_t have = 0;
    while (have < count) {
      const ssize_t got = recv(socket_.number(), into.data() + have, count - have, 0);
      if (got <= 0) return false;
      have += static_cast<std::size_t>(got);
    }
    return true;
  }

  Descriptor socket_;
  bool is_connected_ = false;
};

double timestamp_of(const Package& data) {
  std::string_view rest = std::string_view(data.payload).substr(1);
  return take<double>(rest);
}

class ServedRtde : public testing::Test {
 public:
  template <typename Holds>
  static bool comes_true(const Holds& holds) {
    const auto deadline = steady_clock::now() + std::chrono::seconds(10);
    while (!holds()) {
      if (steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(milliseconds(1));
    }
    return true;
  }

  TickingArm arm;
  RtdeServer server{arm, six_axes(), {.port = 0}};
};

TEST_F(ServedRtde, ShowsNoCycleTwiceAndNeverGoesBack) {
  Client client(server.port());
  client.start(500.0, "timestamp,actual_q");
  double last = -1.0;
  for (int i = 0; i < 100; ++i) {
    const auto data = client.next();
    ASSERT_TRUE(data && data->type == 'U');
    const double time = timestamp_of(*data);
    ASSERT_GT(time, last + 0.0019 * (i > 0));
    last = time;
  }
}

TEST_F(ServedRtde, ActsOnWhatClientsTell) {
  Client client(server.port());
  client.send(greeting() + input_setup("speed_slider_mask,speed_slider_fraction") +
              input_setup("standard_digital_output_mask,standard_digital_output") +
              told(1, std::uint32_t{1}, 0.5) + told(2, std::uint8_t{8}, std::uint8_t{8}));
  EXPECT_TRUE(comes_true([&] { return arm.override_share == 0.5 && arm.outputs == 8U; }));
}

TEST_F(ServedRtde, LosesTheOlderPackagesOfAClientThatReadsTooSlowly) {
  Client slow(server.port(), 4096);
  slow.start(500.0, "timestamp,target_q,target_qd,target_qdd,actual_q,actual_qd,joint_mode");
  std::this_thread::sleep_for(milliseconds(1000));
  Client quick(server.port());
  quick.start(500.0, "timestamp");
  const double now = timestamp_of(quick.next().value());
  // What was under way comes whole and in order, then what is new: the rest is lost.
  double last = -1.0, largest_gap = 0.0;
  int count = 0;
  while (last < now) {
    const auto data = slow.next();
    ASSERT_TRUE(data.has_value());
    const double time = timestamp_of(*data);
    ASSERT_GT(time, last);
    if (count > 0) largest_gap = std::max(largest_gap, time - last);
    last = time;
    ++count;
  }
  EXPECT_LT(count, 300);
  EXPECT_GT(largest_gap, 0.2);
}

TEST_F(ServedRtde, TurnsAwayClientsBeyondItsNumberAndHasRoomAgainLater) {
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < RtdeServer::kMostClients; ++i) {
    clients.push_back(std::make_unique<Client>(server.port()));
    clients.back()->start(10.0, "timestamp");
  }
  Client beyond(server.port());
  EXPECT_FALSE(beyond.next().has_value());
  EXPECT_EQ(clients.front()->next().value_or(Package{}).type, 'U');
  clients.pop_back();
  EXPECT_TRUE(comes_true([&] {
    Client again(server.port());
    again.send(greeting());
    return again.next() == Package{'V', "\1"};
  }));
}

TEST_F(ServedRtde, ClosesWhatBreaksTheProtocolAndServesTheOthers) {
  Client good(server.port()), bad(server.port());
  good.start(100.0, "timestamp");
  bad.send("GET / HTTP/1.1\r\n\r\n");
  EXPECT_EQ(bad.next().value_or(Package{}).type, 'M');
  EXPECT_FALSE(bad.next().has_value());
  EXPECT_EQ(good.next().value_or(Package{}).type, 'U');
}

TEST(RtdeServerRefuses, ArmsAddressesAndPortsThatItCannotServe) {
  TickingArm arm;
  const ForwardKinematics five(std::vector<ChainJoint>(5), Pose::Identity());
  const auto code_of = [&arm](const ForwardKinematics& kinematics, const RtdeOptions& options) {
    try {
      const RtdeServer server(arm, kinematics, options);
    } catch (const MotionError& error) {
      return error.code();
    }
    return ErrorCode::kInternal;
  };
  EXPECT_EQ(code_of(five, {.port = 0}), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(six_axes(), {.address = "localhost", .port = 0}), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(six_axes(), {.port = 65536}), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(six_axes(), {.address = "0.0.0.0", .port = 0}), ErrorCode::kBadArgument);
  const RtdeServer first(arm, six_axes(), {.port = 0});
  EXPECT_EQ(code_of(six_axes(), {.port = first.port()}), ErrorCode::kBusy);
}

}  // namespace
}  // namespace viapoint::rtde
