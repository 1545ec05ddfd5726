#include "rtde/socket.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>

#include "viapoint/core/error.hpp"

namespace viapoint::rtde {
namespace {

constexpr int kBacklog = 64;
/// A client that has gone without a word is found out within 25 s.
constexpr int kProbeAfter = 10, kProbeEvery = 5, kProbes = 3;

union Address {
  sockaddr any;
  sockaddr_in v4;
  sockaddr_in6 v6;
};

std::string reason() { return std::system_category().message(errno); }

void set(int socket, int level, int option, int value) {
  // Each of these only makes things better.
  (void)setsockopt(socket, level, option, &value, sizeof value);
}

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) close(number_);
}

Descriptor listen_at(const std::string& address, int port) {
  Address where{};
  socklen_t size = sizeof where.v4;
  const auto port_bytes = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &where.v4.sin_addr) == 1) {
    where.v4.sin_family = AF_INET;
    where.v4.sin_port = port_bytes;
  } else if (inet_pton(AF_INET6, address.c_str(), &where.v6.sin6_addr) == 1) {
    where.v6.sin6_family = AF_INET6;
    where.v6.sin6_port = port_bytes;
    size = sizeof where.v6;
  } else {
    throw MotionError(ErrorCode::kBadArgument, "\"" + address + "\" is no address in numbers",
                      {"for example 127.0.0.1, or ::1"});
  }
  if (port < 0 || port > 65535) {
    throw MotionError(ErrorCode::kBadArgument,
                      "port " + std::to_string(port) + " is none; ports are 0 to 65535");
  }
  Descriptor listener(socket(where.any.sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  set(listener.number(), SOL_SOCKET, SO_REUSEADDR, 1);
  if (!listener.is_open() || bind(listener.number(), &where.any, size) != 0 ||
      listen(listener.number(), kBacklog) != 0) {
    throw MotionError(
        ErrorCode::kBusy,
        "cannot listen on " + address + " port " + std::to_string(port) + ": " + reason(),
        {"end the program that listens there, or choose another port"});
  }
  return listener;
}

int port_of(const Descriptor& listener) {
  Address where{};
  socklen_t size = sizeof where;
  if (getsockname(listener.number(), &where.any, &size) != 0) return 0;
  return ntohs(where.any.sa_family == AF_INET ? where.v4.sin_port : where.v6.sin6_port);
}

Descriptor accept_at(const Descriptor& listener) {
  Descriptor client(accept4(listener.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!client.is_open()) return client;
  set(client.number(), IPPROTO_TCP, TCP_NODELAY, 1);
  set(client.number(), SOL_SOCKET, SO_KEEPALIVE, 1);
  set(client.number(), IPPROTO_TCP, TCP_KEEPIDLE, kProbeAfter);
  set(client.number(), IPPROTO_TCP, TCP_KEEPINTVL, kProbeEvery);
  set(client.number(), IPPROTO_TCP, TCP_KEEPCNT, kProbes);
  return client;
}

void bound_send_buffer(const Descriptor& to, int bytes) {
  set(to.number(), SOL_SOCKET, SO_SNDBUF, bytes);
}

std::optional<std::size_t> send_some(const Descriptor& to, std::string_view bytes) {
  const ssize_t sent = send(to.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent >= 0) return static_cast<std::size_t>(sent);
  if (errno == EAGAIN || errno == EINTR) return 0;
  return std::nullopt;
}

std::optional<std::size_t> receive_some(const Descriptor& from, std::span<char> bytes) {
  const ssize_t received = recv(from.number(), bytes.data(), bytes.size(), 0);
  if (received > 0) return static_cast<std::size_t>(received);
  if (received < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  return std::nullopt;
}

void end_of_speech(const Descriptor& to) { (void)shutdown(to.number(), SHUT_WR); }

}  // namespace viapoint::rtde
