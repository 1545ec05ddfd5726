#include "controller/connection_gate.hpp"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <utility>

namespace viapoint::controller {
namespace {

/// Whatever the system would allow.
constexpr int kMostDescriptors = 1024;
/// For logs, drives, RTDE and the like.
constexpr int kReserve = 64;
constexpr std::size_t kMostTurnedAway = 8;
constexpr std::int64_t kTellEvery = 10;  ///< [s]
constexpr int kPause = 100;              ///< where the system has no descriptor at all [ms]

int descriptors_for_clients() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kMostDescriptors + kReserve) {
    return kMostDescriptors;
  }
  return std::max(static_cast<int>(limit.rlim_cur) - kReserve, kReserve);
}

std::int64_t seconds_of_clock() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec;
}

}  // namespace

ConnectionGate::ConnectionGate(const std::string& address, int port, std::string farewell,
                               LetIn let_in)
    : farewell_(std::move(farewell)),
      let_in_(std::move(let_in)),
      most_descriptors_(descriptors_for_clients()),
      listener_(rtde::listen_at(address, port)),
      bell_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      told_(seconds_of_clock() - kTellEvery),
      thread_([this] { work(); }) {}

ConnectionGate::~ConnectionGate() {
  quits_.store(true, std::memory_order_release);
  const std::uint64_t one = 1;
  (void)!write(bell_.number(), &one, sizeof one);
  thread_.join();
}

void ConnectionGate::work() {
  std::array<pollfd, 2> waited{{{bell_.number(), POLLIN, 0}, {listener_.number(), POLLIN, 0}}};
  while (!quits_.load(std::memory_order_acquire)) {
    if (poll(waited.data(), waited.size(), -1) > 0 && waited[1].revents != 0) admit();
  }
}

void ConnectionGate::admit() {
  rtde::Descriptor client = rtde::accept_at(listener_);
  if (!client.is_open()) {
    // Nobody waits any more, or the system has no room: the bell ends this pause, too.
    pollfd bell{bell_.number(), POLLIN, 0};
    (void)poll(&bell, 1, kPause);
  } else if (client.number() < most_descriptors_) {
    // The system gives the lowest number that is free, so this one tells how many are in use.
    let_in_(client.release());
  } else {
    turn_away(std::move(client));
  }
}

void ConnectionGate::turn_away(rtde::Descriptor client) {
  (void)rtde::send_some(client, farewell_);
  rtde::end_of_speech(client);
  turned_away_.push_back(std::move(client));
  if (turned_away_.size() > kMostTurnedAway) turned_away_.pop_front();
  ++refusals_;
  const std::int64_t now = seconds_of_clock();
  if (now - told_ < kTellEvery) return;
  spdlog::warn("{} files and connections are open: {} clients turned away so far",
               most_descriptors_, refusals_);
  told_ = now;
}

}  // namespace viapoint::controller
