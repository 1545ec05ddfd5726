/// @file
/// UR's Real-Time Data Exchange, the server's side: programs written for it look on.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/rtde/rtde_arm.hpp"

namespace viapoint {

struct RtdeOptions {
  std::string address = "127.0.0.1";  ///< in numbers, IPv4 or IPv6
  int port = 30004;                   ///< 0: the system chooses
  /// The loop's. Packages come at most once a cycle.
  std::chrono::nanoseconds cycle{2'000'000};
  /// The word for an address that others than this machine can reach.
  bool other_machines = false;
};

/// Listens for RTDE clients (protocol version 2), and serves all of them from one thread of
/// ordinary priority. Each gets what the newest cycle was, at the rate it asked for; one that reads
/// too slowly loses packages, the older first. The loop never waits for any of them.
///
/// The protocol knows neither passwords nor encryption: whoever reaches the port may turn the speed
/// slider and switch outputs. Source: Universal Robots, Real-Time Data Exchange (RTDE) Guide.
/// Threads: any. Real-time: not.
class RtdeServer {
 public:
  /// A client beyond so many is turned away.
  static constexpr int kMostClients = 16;

  /// @param arm outlives the server; @param kinematics what the tool's pose is found with
  /// @throws MotionError(kBadArgument) for an arm of other than six joints, an address that is
  /// none,
  ///   or one beyond this machine without the word for it; kBusy where it cannot be listened on
  RtdeServer(RtdeArm& arm, const ForwardKinematics& kinematics, const RtdeOptions& options = {});
  /// Ends every connection.
  ~RtdeServer();
  RtdeServer(const RtdeServer&) = delete;
  RtdeServer& operator=(const RtdeServer&) = delete;

  /// The port listened on, also where port 0 left the choice to the system.
  [[nodiscard]] int port() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viapoint
