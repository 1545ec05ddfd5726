/// @file
/// Bytes of an RTDE package: big-endian throughout, doubles as IEEE 754.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace viapoint::rtde {

using Bytes = std::string;

/// First letter of each package; client and server use the same for question and answer.
enum class PackageType : std::uint8_t {
  kProtocolVersion = 'V',
  kControllerVersion = 'v',
  kTextMessage = 'M',
  kData = 'U',
  kSetupOutputs = 'O',
  kSetupInputs = 'I',
  kStart = 'S',
  kPause = 'P',
};

inline constexpr std::size_t kHeaderBytes = 3;  ///< length of the whole package, and its type

template <typename T>
using Word = std::conditional_t<
    sizeof(T) == 8, std::uint64_t,
    std::conditional_t<sizeof(T) == 4, std::uint32_t,
                       std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;

/// Appends a number.
template <typename T>
void put(Bytes& bytes, T value) {
  const auto word = std::bit_cast<Word<T>>(value);
  for (std::size_t i = sizeof(T); i-- > 0;) {
    bytes.push_back(static_cast<char>(static_cast<std::uint64_t>(word) >> (8 * i)));
  }
}

/// Takes a number from the front. @pre bytes.size() >= sizeof(T)
template <typename T>
[[nodiscard]] T take(std::string_view& bytes) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    word = (word << 8) | static_cast<std::uint8_t>(bytes[i]);
  }
  bytes.remove_prefix(sizeof(T));
  return std::bit_cast<T>(static_cast<Word<T>>(word));
}

/// A whole package. @pre the payload fits 16 bits of length
[[nodiscard]] inline Bytes package(PackageType type, std::string_view payload) {
  Bytes bytes;
  put(bytes, static_cast<std::uint16_t>(kHeaderBytes + payload.size()));
  bytes.push_back(static_cast<char>(type));
  bytes += payload;
  return bytes;
}

}  // namespace viapoint::rtde
