/// @file
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "viapoint/drives/udp_frame.hpp"
#include "viapoint/realtime/drive.hpp"

namespace viapoint {

/// Datagrams so far. Written by the loop, read by any thread.
struct UdpTraffic {
  using Count = std::atomic<std::uint64_t>;
  Count sent{0};
  Count unsent{0};    ///< that the system did not take, or that nobody listens to
  Count answered{0};  ///< answers that were taken
  Count silent{0};    ///< cycles without an answer
  // Ignored:
  Count wrong_size{0};
  Count wrong_magic{0};
  Count wrong_version{0};
  Count wrong_joints{0};
  Count not_finite{0};  ///< a joint is infinite or no number
  Count old{0};         ///< not newer than the answer before, or to a command that was never sent
};

/// Where the device is.
struct UdpDriveOptions {
  std::string host = "127.0.0.1";  ///< address in numbers, IPv4 or IPv6
  int port = 0;
  int joints = 0;
  std::chrono::milliseconds patience{1000};  ///< of enable(), for the first answer
};

/// Drives behind a device that takes a datagram of setpoints a cycle and answers each with what it
/// has measured (udp_frame.hpp). Nothing blocks: a cycle takes the newest answer that is there, as
/// a rule the one to the cycle before, and is silent without one (DriveStatus::kSilent), which the
/// guard bears for GuardOptions::silent_cycles. The device has to stop by itself when it hears
/// nothing any more.
class UdpDrive final : public Drive {
 public:
  /// Opens a socket that talks to that device only.
  /// @param traffic to count in; none: nobody looks
  /// @throws MotionError(kBadArgument) for an address that is none in numbers, a port outside 1 to
  ///   65535, joints outside 1 to 16; kDriveFault with the system's reason
  explicit UdpDrive(UdpDriveOptions options, std::shared_ptr<UdpTraffic> traffic = nullptr);
  ~UdpDrive() override;
  UdpDrive(const UdpDrive&) = delete;
  UdpDrive& operator=(const UdpDrive&) = delete;

  [[nodiscard]] int joints() const override { return options_.joints; }
  /// Asks the device until it follows. @throws MotionError(kDriveFault) when it does not in time,
  /// reports a fault, or has another number of joints
  Measurement enable() override;
  [[nodiscard]] DriveStatus exchange(const Setpoint& setpoint,
                                     Measurement& measurement) noexcept override;
  /// Tells the device three times, as datagrams may be lost.
  void release() noexcept override;
  [[nodiscard]] std::string fault() const override;

 private:
  void send(udp::Order order) noexcept;
  /// Takes all answers that are there, and keeps the newest in `answer_`; false where there is
  /// none.
  bool receive() noexcept;
  void count(udp::Flaw flaw) noexcept;
  [[nodiscard]] std::string ignored() const;

  UdpDriveOptions options_;
  std::shared_ptr<UdpTraffic> traffic_;
  int socket_ = -1;
  udp::Command command_;
  udp::Answer answer_, arrived_;
  udp::Datagram datagram_{};
};

}  // namespace viapoint
