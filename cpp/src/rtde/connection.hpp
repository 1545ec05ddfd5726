/// @file
/// A client and its socket.
#pragma once

#include <cstdint>

#include "rtde/session.hpp"
#include "rtde/socket.hpp"

namespace viapoint::rtde {

/// Never waits: what a client does not read stays here, and of the data only the newest package.
/// Threads: one.
class Connection {
 public:
  /// @param now [ns], as everywhere here
  Connection(Descriptor socket, RtdeArm& arm, double cycle, std::int64_t now)
      : socket_(std::move(socket)), session_(arm, cycle), began_(now), moved_(now) {}

  [[nodiscard]] int descriptor() const { return socket_.number(); }
  [[nodiscard]] bool is_started() const { return session_.is_started(); }
  /// True where there is something that the client has to read first.
  [[nodiscard]] bool has_to_send() const { return !outbox_.empty() || !newest_.empty(); }
  /// True when the connection has to end: the client has gone, broken the protocol, says nothing,
  /// or reads nothing.
  [[nodiscard]] bool is_over(std::int64_t now) const;

  /// Reads what has come, a bounded part of it, and answers.
  void read();
  /// Sends what is due.
  void show(const ArmView& view);
  /// Sends what it can.
  void send(std::int64_t now);

 private:
  Descriptor socket_;
  Session session_;
  std::int64_t began_;
  std::int64_t moved_;  ///< when there was nothing to send, or some of it went
  bool is_gone_ = false;
  Bytes outbox_;  ///< answers, and the rest of a package that went in part
  Bytes newest_;  ///< package of data that waits for it
};

}  // namespace viapoint::rtde
