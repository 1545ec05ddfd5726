#include "viapoint/drives/udp_drive.hpp"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

/// Of a device that floods the loop, no more than so many datagrams are looked at in a cycle.
constexpr int kMostDatagrams = 16;
/// How often a device is asked for power [ms].
constexpr int kAskingPeriod = 20;
constexpr int kFarewells = 3;

void count_one(UdpTraffic::Count& count) noexcept { count.fetch_add(1, std::memory_order_relaxed); }

std::int64_t now() noexcept {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

void check(const UdpDriveOptions& options) {
  if (options.port < 1 || options.port > 65535) {
    throw MotionError(
        ErrorCode::kBadArgument,
        "the device's port is " + std::to_string(options.port) + "; allowed are 1 to 65535");
  }
  if (options.joints < 1 || options.joints > kMaxJoints) {
    throw MotionError(ErrorCode::kBadArgument, "a drive has 1 to " + std::to_string(kMaxJoints) +
                                                   " joints, not " +
                                                   std::to_string(options.joints));
  }
}

/// A socket that sends to the device, and receives from nobody else.
int connected_socket(const UdpDriveOptions& options) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(options.port);
  if (getaddrinfo(options.host.c_str(), port.c_str(), &hints, &found) != 0) {
    throw MotionError(ErrorCode::kBadArgument, "\"" + options.host + "\" is no address in numbers",
                      {"for example 127.0.0.1, or ::1"});
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> address(found, &freeaddrinfo);
  const int descriptor = socket(address->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor >= 0 && connect(descriptor, address->ai_addr, address->ai_addrlen) == 0) {
    return descriptor;
  }
  const std::string reason = std::strerror(errno);
  if (descriptor >= 0) close(descriptor);
  throw MotionError(ErrorCode::kDriveFault,
                    "no socket for the device at " + options.host + ": " + reason);
}

}  // namespace

UdpDrive::UdpDrive(UdpDriveOptions options, std::shared_ptr<UdpTraffic> traffic)
    : options_(std::move(options)),
      traffic_(traffic != nullptr ? std::move(traffic) : std::make_shared<UdpTraffic>()) {
  check(options_);
  command_.q = command_.qd = answer_.q = JointVector::Zero(options_.joints);
  socket_ = connected_socket(options_);
}

UdpDrive::~UdpDrive() { close(socket_); }

Measurement UdpDrive::enable() {
  using Clock = std::chrono::steady_clock;
  command_.q.setZero();
  command_.qd.setZero();
  const auto end = Clock::now() + options_.patience;
  do {
    send(udp::Order::kEnable);
    pollfd wanted{socket_, POLLIN, 0};
    poll(&wanted, 1, kAskingPeriod);
    if (!receive()) continue;
    const bool is_up = answer_.condition == udp::Condition::kFollowing ||
                       answer_.condition == udp::Condition::kGuided;
    if (is_up) return {answer_.q, answer_.inputs};
    if (answer_.condition != udp::Condition::kOff) {
      throw MotionError(ErrorCode::kDriveFault, fault());
    }
  } while (Clock::now() < end);
  const std::string seconds = std::to_string(options_.patience.count()) + " ms";
  const std::string what = traffic_->answered > 0
                               ? "the device has not powered up within " + seconds
                               : "no device has answered within " + seconds + ignored();
  throw MotionError(
      ErrorCode::kDriveFault,
      what + " (" + options_.host + ", port " + std::to_string(options_.port) + ")",
      {"start the device, and see that it listens there",
       "see that it has as many joints as the robot, " + std::to_string(options_.joints)});
}

DriveStatus UdpDrive::exchange(const Setpoint& setpoint, Measurement& measurement) noexcept {
  command_.q = setpoint.q;
  command_.qd = setpoint.qd;
  command_.outputs = setpoint.outputs;
  send(udp::Order::kFollow);
  if (!receive()) {
    count_one(traffic_->silent);
    return DriveStatus::kSilent;
  }
  measurement.q = answer_.q;
  measurement.inputs = answer_.inputs;
  switch (answer_.condition) {
    case udp::Condition::kFollowing:
      return DriveStatus::kOk;
    case udp::Condition::kGuided:
      return DriveStatus::kGuided;
    case udp::Condition::kOff:
    case udp::Condition::kPowerLost:
      return DriveStatus::kPowerLost;
    case udp::Condition::kFault:
      return DriveStatus::kFault;
  }
  return DriveStatus::kFault;
}

void UdpDrive::release() noexcept {
  for (int i = 0; i < kFarewells; ++i) send(udp::Order::kRelease);
}

std::string UdpDrive::fault() const {
  const std::string code = " (code " + std::to_string(answer_.fault_code) + ")";
  switch (answer_.condition) {
    case udp::Condition::kOff:
      return "the device has switched its power off" + code;
    case udp::Condition::kPowerLost:
      return "the device has lost its power" + code;
    case udp::Condition::kGuided:
      return "the device is guided by hand";
    case udp::Condition::kFollowing:
    case udp::Condition::kFault:
      return "the device reports a fault" + code;
  }
  return "the device tells a condition that there is not, " +
         std::to_string(static_cast<int>(answer_.condition));
}

void UdpDrive::send(udp::Order order) noexcept {
  command_.order = order;
  command_.stamp = now();
  ++command_.sequence;
  const std::size_t size = udp::encode(command_, datagram_);
  const ssize_t sent = ::send(socket_, datagram_.data(), size, MSG_DONTWAIT | MSG_NOSIGNAL);
  count_one(sent == static_cast<ssize_t>(size) ? traffic_->sent : traffic_->unsent);
}

bool UdpDrive::receive() noexcept {
  bool is_any = false;
  for (int i = 0; i < kMostDatagrams; ++i) {
    const ssize_t size = recv(socket_, datagram_.data(), datagram_.size(), MSG_DONTWAIT);
    if (size < 0 && errno == ECONNREFUSED) continue;  // tells of a datagram sent before
    if (size < 0) break;
    const udp::Flaw flaw =
        udp::decode({datagram_.data(), static_cast<std::size_t>(size)}, options_.joints, arrived_);
    if (flaw != udp::Flaw::kNone) {
      count(flaw);
    } else if (arrived_.sequence <= answer_.sequence || arrived_.sequence > command_.sequence) {
      count_one(traffic_->old);
    } else {
      std::swap(answer_, arrived_);
      count_one(traffic_->answered);
      is_any = true;
    }
  }
  return is_any;
}

void UdpDrive::count(udp::Flaw flaw) noexcept {
  switch (flaw) {
    case udp::Flaw::kNone:
      return;
    case udp::Flaw::kSize:
      return count_one(traffic_->wrong_size);
    case udp::Flaw::kMagic:
      return count_one(traffic_->wrong_magic);
    case udp::Flaw::kVersion:
      return count_one(traffic_->wrong_version);
    case udp::Flaw::kJoints:
      return count_one(traffic_->wrong_joints);
    case udp::Flaw::kNotFinite:
      return count_one(traffic_->not_finite);
  }
}

std::string UdpDrive::ignored() const {
  const auto told = [](const UdpTraffic::Count& count, const char* what) {
    const std::uint64_t number = count.load();
    return number == 0 ? std::string() : "; " + std::to_string(number) + " answers " + what;
  };
  return told(traffic_->wrong_size, "were of a wrong size") +
         told(traffic_->wrong_magic, "were none of this protocol") +
         told(traffic_->wrong_version, "were of another version") +
         told(traffic_->wrong_joints, "were for another number of joints") +
         told(traffic_->not_finite, "told a joint that is infinite or no number") +
         told(traffic_->old, "were old");
}

}  // namespace viapoint
