/// @file
/// The two datagrams between the loop and a device that takes setpoints over UDP (docs/drives.md).
/// All numbers little-endian, floats IEEE 754 of 64 bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint::udp {

inline constexpr std::uint8_t kFrameVersion = 1;

/// What the device is asked for.
enum class Order : std::uint8_t { kEnable = 1, kFollow = 2, kRelease = 3 };

/// From the loop to the device: "VPSP", version, order, n, 0, then `sequence`, `stamp`, `outputs`
/// of 8 bytes each, q (n,) and qd (n,). 32 + 16 n bytes.
struct Command {
  Order order = Order::kFollow;
  std::uint64_t sequence = 0;  ///< from 1, one more in every datagram
  std::int64_t stamp = 0;      ///< of the sender's monotonic clock [ns]
  std::uint64_t outputs = 0;   ///< bit i is output i
  JointVector q, qd;           ///< (n,) [rad or m, and per s]
};

/// What the device says of itself.
enum class Condition : std::uint8_t {
  kOff = 0,        ///< without power
  kFollowing = 1,  ///< follows the setpoints
  kFault = 2,
  kPowerLost = 3,  ///< stop category 0
  kGuided = 4,     ///< moved by hand
};

/// From the device to the loop, one for each command: "VPMS", version, condition, n, 0, then
/// `sequence`, `stamp`, `inputs` of 8 bytes each, `fault_code` and 0 of 4 bytes each, q (n,).
/// 40 + 8 n bytes.
struct Answer {
  Condition condition = Condition::kOff;
  std::uint64_t sequence = 0;  ///< of the newest command that has arrived
  std::int64_t stamp = 0;      ///< that command's, as it was
  std::uint64_t inputs = 0;    ///< bit i is input i
  std::uint32_t fault_code = 0;
  JointVector q;  ///< as measured, (n,) [rad or m]
};

/// Room for one byte more than the longest: a longer datagram is not mistaken for it.
using Datagram = std::array<std::uint8_t, 32 + 16 * kMaxJoints + 1>;

/// Why a datagram is none.
enum class Flaw : std::uint8_t {
  kNone,
  kSize,
  kMagic,
  kVersion,
  kJoints,
  kNotFinite  ///< a joint is infinite or no number
};

/// Returns how many bytes of `datagram` it takes. Real-time: safe.
std::size_t encode(const Command& command, Datagram& datagram) noexcept;
std::size_t encode(const Answer& answer, Datagram& datagram) noexcept;
/// Fills in the message, where kNone is returned. Real-time: safe.
/// @param joints n
[[nodiscard]] Flaw decode(std::span<const std::uint8_t> bytes, int joints,
                          Command& command) noexcept;
[[nodiscard]] Flaw decode(std::span<const std::uint8_t> bytes, int joints, Answer& answer) noexcept;

}  // namespace viapoint::udp
