#include "viapoint/drives/udp_frame.hpp"

#include <algorithm>
#include <bit>

namespace viapoint::udp {
namespace {

using Magic = std::array<std::uint8_t, 4>;
constexpr Magic kCommand{'V', 'P', 'S', 'P'};
constexpr Magic kAnswer{'V', 'P', 'M', 'S'};
constexpr std::size_t kHead = 8;

/// Writes one number after the other.
class Writer {
 public:
  explicit Writer(Datagram& datagram) : datagram_(datagram) {}
  template <typename Unsigned>
  void put(Unsigned value) noexcept {
    for (std::size_t byte = 0; byte < sizeof(Unsigned); ++byte) {
      datagram_[size_++] = static_cast<std::uint8_t>(value >> (8 * byte) & 0xffU);
    }
  }
  void put(const JointVector& values) noexcept {
    for (const double value : values) put(std::bit_cast<std::uint64_t>(value));
  }
  void put_head(const Magic& magic, std::uint8_t kind, Eigen::Index joints) noexcept {
    for (const std::uint8_t letter : magic) put(letter);
    put(kFrameVersion);
    put(kind);
    put(static_cast<std::uint8_t>(joints));
    put(std::uint8_t{0});
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  Datagram& datagram_;
  std::size_t size_ = 0;
};

/// Reads one number after the other.
class Reader {
 public:
  /// The bytes behind the head, where it and the size are as they have to be.
  Flaw open(std::span<const std::uint8_t> bytes, const Magic& magic, int joints,
            std::size_t size) noexcept {
    if (bytes.size() < kHead) return Flaw::kSize;
    if (!std::equal(magic.begin(), magic.end(), bytes.begin())) return Flaw::kMagic;
    if (bytes[4] != kFrameVersion) return Flaw::kVersion;
    if (bytes[6] != joints) return Flaw::kJoints;
    kind_ = bytes[5];
    bytes_ = bytes.subspan(kHead);
    return bytes.size() == size ? Flaw::kNone : Flaw::kSize;
  }
  [[nodiscard]] std::uint8_t kind() const noexcept { return kind_; }
  /// @pre opened, and of as many bytes as are taken
  template <typename Unsigned>
  Unsigned take() noexcept {
    Unsigned value = 0;
    for (std::size_t byte = 0; byte < sizeof(Unsigned); ++byte) {
      value |= static_cast<Unsigned>(bytes_[byte]) << (8 * byte);
    }
    bytes_ = bytes_.subspan(sizeof(Unsigned));
    return value;
  }
  /// Flaw::kNotFinite where one of them is no place to be: nothing that follows could bear it.
  Flaw take(int joints, JointVector& values) noexcept {
    values.resize(joints);
    for (double& value : values) value = std::bit_cast<double>(take<std::uint64_t>());
    return values.allFinite() ? Flaw::kNone : Flaw::kNotFinite;
  }

 private:
  std::uint8_t kind_ = 0;
  std::span<const std::uint8_t> bytes_;
};

}  // namespace

std::size_t encode(const Command& command, Datagram& datagram) noexcept {
  Writer writer(datagram);
  writer.put_head(kCommand, static_cast<std::uint8_t>(command.order), command.q.size());
  writer.put(command.sequence);
  writer.put(static_cast<std::uint64_t>(command.stamp));
  writer.put(command.outputs);
  writer.put(command.q);
  writer.put(command.qd);
  return writer.size();
}

std::size_t encode(const Answer& answer, Datagram& datagram) noexcept {
  Writer writer(datagram);
  writer.put_head(kAnswer, static_cast<std::uint8_t>(answer.condition), answer.q.size());
  writer.put(answer.sequence);
  writer.put(static_cast<std::uint64_t>(answer.stamp));
  writer.put(answer.inputs);
  writer.put(answer.fault_code);
  writer.put(std::uint32_t{0});
  writer.put(answer.q);
  return writer.size();
}

Flaw decode(std::span<const std::uint8_t> bytes, int joints, Command& command) noexcept {
  const std::size_t size = 32 + 16 * static_cast<std::size_t>(joints);
  Reader reader;
  if (const Flaw flaw = reader.open(bytes, kCommand, joints, size); flaw != Flaw::kNone)
    return flaw;
  command.order = static_cast<Order>(reader.kind());
  command.sequence = reader.take<std::uint64_t>();
  command.stamp = static_cast<std::int64_t>(reader.take<std::uint64_t>());
  command.outputs = reader.take<std::uint64_t>();
  if (const Flaw flaw = reader.take(joints, command.q); flaw != Flaw::kNone) return flaw;
  return reader.take(joints, command.qd);
}

Flaw decode(std::span<const std::uint8_t> bytes, int joints, Answer& answer) noexcept {
  const std::size_t size = 40 + 8 * static_cast<std::size_t>(joints);
  Reader reader;
  if (const Flaw flaw = reader.open(bytes, kAnswer, joints, size); flaw != Flaw::kNone) return flaw;
  answer.condition = static_cast<Condition>(reader.kind());
  answer.sequence = reader.take<std::uint64_t>();
  answer.stamp = static_cast<std::int64_t>(reader.take<std::uint64_t>());
  answer.inputs = reader.take<std::uint64_t>();
  answer.fault_code = reader.take<std::uint32_t>();
  reader.take<std::uint32_t>();
  return reader.take(joints, answer.q);
}

}  // namespace viapoint::udp
