/// @file
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "viapoint/core/joint_vector.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/drives/udp_drive.hpp"
#include "viapoint/realtime/guard.hpp"

namespace viapoint::controller {

/// The three files of mutual TLS, PEM each.
struct TlsFiles {
  std::string authority;    ///< what clients' certificates have to be signed by
  std::string certificate;  ///< the controller's own
  std::string key;          ///< to it
};

/// Where RTDE clients are served (docs/rtde.md).
struct RtdeAddress {
  std::string address = "127.0.0.1";  ///< in numbers
  int port = 30004;
  bool other_machines = false;  ///< may reach the address
};

/// What the configuration file says (docs/controller.md). Names of files are absolute, or count
/// from the working directory.
struct Config {
  std::string robot;  ///< built-in name, or path of a .yaml or .urdf
  std::string host = "127.0.0.1";
  int port = 7420;
  std::chrono::nanoseconds cycle{2'000'000};
  std::chrono::nanoseconds heartbeat{100'000'000};
  std::optional<int> processor;           ///< that the loop stays on; none: any
  bool keep_awake = true;                 ///< no deep sleep of the processors
  SimulatedDriveOptions simulated;        ///< its cycle is the one above
  std::optional<UdpDriveOptions> device;  ///< in place of the simulated drive; joints: the robot's
  JointVector start;   ///< where the simulated drive stands [rad or m]; empty: at zero
  GuardOptions guard;  ///< tool speed, workspace, silent cycles; its kinematics come with the robot
  std::optional<TlsFiles> tls;
  std::optional<RtdeAddress> rtde;  ///< none: RTDE is not served
  std::string logs;                 ///< folder for the log of every run; empty: none is written

  /// True where only programs on this machine can connect.
  [[nodiscard]] bool is_loopback() const;
};

/// @throws MotionError(kFile) with file, line and key: what is unknown, missing, there twice or no
///   such value; an address beyond this machine without TLS
[[nodiscard]] Config load_config(const std::string& path);
/// The same of the text of a file; `source` names it in errors, and relative names in it count from
/// its folder.
[[nodiscard]] Config config_from_yaml(const std::string& text, const std::string& source);

}  // namespace viapoint::controller
