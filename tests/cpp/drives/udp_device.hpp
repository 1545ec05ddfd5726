/// @file
/// A device on this machine, for tests of the drive that talks to it.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "viapoint/drives/udp_frame.hpp"

namespace viapoint {

/// Listens at a free port of 127.0.0.1. What it is sent is there at once: loopback does not wait.
class UdpDevice {
 public:
  explicit UdpDevice(int joints) : joints_(joints), socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      throw std::runtime_error("no port for a device");
    }
    port_ = ntohs(address.sin_port);
  }
  ~UdpDevice() { close(socket_); }
  UdpDevice(const UdpDevice&) = delete;
  UdpDevice& operator=(const UdpDevice&) = delete;

  [[nodiscard]] int port() const { return port_; }

  /// The next datagram, within two seconds; empty without one.
  std::vector<std::uint8_t> take() {
    pollfd wanted{socket_, POLLIN, 0};
    if (poll(&wanted, 1, 2000) != 1) return {};
    std::vector<std::uint8_t> bytes(1000);
    socklen_t size = sizeof(peer_);
    const ssize_t count = recvfrom(socket_, bytes.data(), bytes.size(), 0,
                                   reinterpret_cast<sockaddr*>(&peer_), &size);
    bytes.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    return bytes;
  }
  udp::Command take_command() {
    udp::Command command;
    EXPECT_EQ(udp::decode(take(), joints_, command), udp::Flaw::kNone);
    return command;
  }
  /// To who was heard last.
  void send(std::span<const std::uint8_t> bytes) {
    EXPECT_EQ(sendto(socket_, bytes.data(), bytes.size(), 0,
                     reinterpret_cast<const sockaddr*>(&peer_), sizeof(peer_)),
              static_cast<ssize_t>(bytes.size()));
  }
  void send(const udp::Answer& answer) {
    udp::Datagram datagram{};
    send(std::span<const std::uint8_t>(datagram.data(), udp::encode(answer, datagram)));
  }

 private:
  int joints_;
  int socket_;
  int port_ = 0;
  sockaddr_in peer_{};
};

}  // namespace viapoint
