#include "viapoint/rtde/rtde_server.hpp"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <list>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "rtde/arm_view.hpp"
#include "rtde/connection.hpp"
#include "rtde/socket.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

using rtde::ArmView;
using rtde::ArmWatch;
using rtde::Connection;
using rtde::Descriptor;

constexpr std::int64_t kSecond = 1'000'000'000;
/// After the loop's wake-up, by when it has done its cycle; and how often to look where it has not.
constexpr std::int64_t kAfterWakeUp = 300'000;
/// While nobody is shown anything, connections are looked at so often.
constexpr std::int64_t kIdle = kSecond / 2;
/// What the system keeps for a client that does not read. More would be old news.
constexpr int kSendBuffer = 16 << 10;

std::int64_t now_of_clock() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

Descriptor listen(const RtdeOptions& options) {
  Descriptor listener = rtde::listen_at(options.address, options.port);
  if (options.other_machines || options.address.starts_with("127.") || options.address == "::1") {
    return listener;
  }
  throw MotionError(
      ErrorCode::kBadArgument,
      "RTDE has neither passwords nor encryption: at " + options.address +
          " other machines could turn the speed and switch outputs, and nobody would ask who they "
          "are",
      {"serve it on 127.0.0.1", "say that other machines may, where the network is yours"});
}

double seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

ForwardKinematics checked(const ForwardKinematics& kinematics) {
  if (kinematics.joints() == rtde::kAxes) return kinematics;
  throw MotionError(ErrorCode::kBadArgument, "RTDE tells of arms with 6 joints; this one has " +
                                                 std::to_string(kinematics.joints()));
}

}  // namespace

struct RtdeServer::Impl {
  Impl(RtdeArm& of, const ForwardKinematics& kinematics, const RtdeOptions& options)
      : arm(of),
        cycle(options.cycle),
        watch(checked(kinematics), seconds(options.cycle), now_of_clock()),
        listener(listen(options)),
        bell(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    try {
      thread = std::thread([this] { serve(); });
    } catch (const std::system_error& error) {
      throw MotionError(
          ErrorCode::kBusy,
          std::string("the thread of the RTDE server cannot be created: ") + error.what());
    }
  }

  ~Impl() {
    quits.store(true, std::memory_order_release);
    const std::uint64_t one = 1;
    (void)!write(bell.number(), &one, sizeof one);
    thread.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void serve() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    while (!quits.load(std::memory_order_acquire)) {
      wait();
      const std::int64_t now = now_of_clock();
      auto heard = waited.cbegin();
      for (Connection& client : clients) {
        if ((heard++)->revents != 0) client.read();
      }
      show(now);
      for (Connection& client : clients) client.send(now);
      std::erase_if(clients, [now](const Connection& client) { return client.is_over(now); });
      admit(now);
    }
  }

  /// Until there is something to read, room to send, or a new cycle to show.
  void wait() {
    waited.clear();
    for (const Connection& client : clients) {
      const int events = POLLIN | (client.has_to_send() ? POLLOUT : 0);
      waited.push_back({client.descriptor(), static_cast<short>(events), 0});
    }
    waited.push_back({bell.number(), POLLIN, 0});
    const std::int64_t now = now_of_clock();
    if (now >= admits_from) waited.push_back({listener.number(), POLLIN, 0});
    const std::int64_t pause = time_to_look(now);
    const timespec timeout{pause / kSecond, pause % kSecond};
    if (ppoll(waited.data(), waited.size(), &timeout, nullptr) < 0) {
      for (pollfd& each : waited) each.revents = 0;
    }
  }

  /// The loop cannot ring a bell without a system call: its next cycle is foreseen.
  [[nodiscard]] std::int64_t time_to_look(std::int64_t now) const {
    const bool shows = std::any_of(clients.begin(), clients.end(),
                                   [](const Connection& client) { return client.is_started(); });
    if (!shows) return kIdle;
    if (now - seen_stamp >= 2 * cycle.count()) return std::min(cycle.count(), kAfterWakeUp * 4);
    return std::max(seen_stamp + cycle.count() + kAfterWakeUp - now, kAfterWakeUp);
  }

  void show(std::int64_t now) {
    const LoopCycle newest = arm.newest_cycle();
    seen_stamp = newest.stamp;
    const bool is_old = newest.cycle == seen_cycle && ArmWatch::is_alive(newest, now);
    seen_cycle = newest.cycle;
    if (is_old) return;
    const ArmView view = watch.see(newest, now);
    for (Connection& client : clients) client.show(view);
  }

  void admit(std::int64_t now) {
    if (waited.back().fd != listener.number() || waited.back().revents == 0) return;
    // One at a time, so that a crowd does not keep the others waiting.
    Descriptor client = rtde::accept_at(listener);
    if (!client.is_open()) admits_from = now + kIdle;  // the system has no room now
    if (!client.is_open() || clients.size() >= kMostClients) return;
    rtde::bound_send_buffer(client, kSendBuffer);
    clients.emplace_back(std::move(client), arm, seconds(cycle), now);
  }

  RtdeArm& arm;
  const std::chrono::nanoseconds cycle;
  ArmWatch watch;
  Descriptor listener, bell;
  std::atomic<bool> quits{false};
  std::list<Connection> clients;
  std::vector<pollfd> waited;  ///< the clients in order, then bell and listener
  std::int64_t admits_from = 0;
  std::uint64_t seen_cycle = 0;
  std::int64_t seen_stamp = 0;
  std::thread thread;
};

RtdeServer::RtdeServer(RtdeArm& arm, const ForwardKinematics& kinematics,
                       const RtdeOptions& options)
    : impl_(std::make_unique<Impl>(arm, kinematics, options)) {}

RtdeServer::~RtdeServer() = default;

int RtdeServer::port() const { return rtde::port_of(impl_->listener); }

}  // namespace viapoint
