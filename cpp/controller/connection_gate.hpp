/// @file
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <thread>

#include "rtde/socket.hpp"

namespace viapoint::controller {

/// Lets clients in while the process has file descriptors to spare, and turns the others away with
/// a word. gRPC's own listener knows no such bound, and listens no more once the system has had
/// none left. Threads: one of its own.
class ConnectionGate {
 public:
  /// Told of every socket let in, which is its from then on.
  using LetIn = std::function<void(int socket)>;

  /// @param address in numbers, without brackets
  /// @param farewell bytes that those turned away are sent; empty: none
  /// @throws MotionError(kBadArgument, kBusy) where the address cannot be listened on
  ConnectionGate(const std::string& address, int port, std::string farewell, LetIn let_in);
  ~ConnectionGate();
  ConnectionGate(const ConnectionGate&) = delete;
  ConnectionGate& operator=(const ConnectionGate&) = delete;

  [[nodiscard]] int port() const { return rtde::port_of(listener_); }

 private:
  void work();
  void admit();
  void turn_away(rtde::Descriptor client);

  const std::string farewell_;
  const LetIn let_in_;
  const int most_descriptors_;
  rtde::Descriptor listener_, bell_;
  std::atomic<bool> quits_{false};
  // What follows is the thread's.
  std::deque<rtde::Descriptor> turned_away_;  ///< the newest, open until they have read why
  std::uint64_t refusals_ = 0;
  std::int64_t told_ = 0;  ///< when refusals were logged last [s]
  std::thread thread_;
};

}  // namespace viapoint::controller
