#include <cstdint>
#include <span>
#include <vector>

#include "fuzz/broken_promise.hpp"
#include "fuzz/targets.hpp"
#include "viapoint/drives/udp_frame.hpp"

namespace viapoint::fuzz {
namespace {

/// What was taken is sent as it came, but for the zeros that nobody reads.
template <typename Message>
void decode_and_encode(std::span<const std::uint8_t> bytes, int joints) {
  Message message;
  if (udp::decode(bytes, joints, message) != udp::Flaw::kNone) return;
  promise(message.q.size() == joints, "a datagram of another number of joints");
  udp::Datagram datagram{};
  const std::size_t size = udp::encode(message, datagram);
  promise(size == bytes.size(), "a datagram of another length");
  Message again;
  promise(udp::decode({datagram.data(), size}, joints, again) == udp::Flaw::kNone,
          "a datagram that was taken does not read back");
  udp::Datagram twice{};
  promise(udp::encode(again, twice) == size && twice == datagram, "a datagram that changes");
}

}  // namespace

/// The first byte says how many joints the arm has.
void udp(std::string_view bytes) {
  if (bytes.empty()) return;
  const int joints = 1 + static_cast<unsigned char>(bytes.front()) % kMaxJoints;
  bytes.remove_prefix(1);
  const std::vector<std::uint8_t> datagram(bytes.begin(), bytes.end());
  decode_and_encode<udp::Command>(datagram, joints);
  decode_and_encode<udp::Answer>(datagram, joints);
}

}  // namespace viapoint::fuzz
