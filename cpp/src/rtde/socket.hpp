/// @file
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace viapoint::rtde {

/// A socket or other descriptor, closed with its owner.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor();

  [[nodiscard]] int number() const { return number_; }
  /// Hands it over to whoever closes it.
  [[nodiscard]] int release() { return std::exchange(number_, -1); }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }

 private:
  int number_ = -1;
};

/// @throws MotionError(kBadArgument, kBusy)
[[nodiscard]] Descriptor listen_at(const std::string& address, int port);
[[nodiscard]] int port_of(const Descriptor& listener);
/// The next client, if one waits.
[[nodiscard]] Descriptor accept_at(const Descriptor& listener);

/// Has the system keep no more than this for a client that does not read.
void bound_send_buffer(const Descriptor& to, int bytes);

/// How many bytes went or came: 0 where the other side makes us wait, nothing where it is gone.
[[nodiscard]] std::optional<std::size_t> send_some(const Descriptor& to, std::string_view bytes);
[[nodiscard]] std::optional<std::size_t> receive_some(const Descriptor& from,
                                                      std::span<char> bytes);
/// Tells the other side that nothing more comes.
void end_of_speech(const Descriptor& to);

}  // namespace viapoint::rtde
