#include "rtde/connection.hpp"

#include <array>
#include <utility>

namespace viapoint::rtde {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kGreeting = 5 * kSecond;  ///< within which a client has to say what it is
constexpr std::int64_t kStall = 30 * kSecond;    ///< that a client may go without reading
/// Answers that wait for a client which asks and does not read.
constexpr std::size_t kMostAnswers = 256U << 10;
constexpr std::size_t kReadBytes = 4096;

}  // namespace

bool Connection::is_over(std::int64_t now) const {
  if (is_gone_ || outbox_.size() > kMostAnswers) return true;
  if (session_.is_broken()) return outbox_.empty() || now - moved_ > kSecond;
  if (!session_.has_greeted() && now - began_ > kGreeting) return true;
  return has_to_send() && now - moved_ > kStall;
}

void Connection::read() {
  std::array<char, kReadBytes>
      bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled next
  const std::optional<std::size_t> count = receive_some(socket_, bytes);
  is_gone_ = is_gone_ || !count;
  if (!count || *count == 0 || session_.is_broken()) return;
  outbox_ += session_.receive({bytes.data(), *count});
  if (!session_.is_started()) newest_.clear();
}

void Connection::show(const ArmView& view) {
  if (session_.is_due(view.time)) newest_ = session_.data(view);
}

void Connection::send(std::int64_t now) {
  while (!is_gone_) {
    if (outbox_.empty()) outbox_ = std::exchange(newest_, {});
    if (outbox_.empty()) {
      moved_ = now;
      return;
    }
    const std::optional<std::size_t> count = send_some(socket_, outbox_);
    is_gone_ = !count;
    if (!count || *count == 0) return;
    outbox_.erase(0, *count);
    moved_ = now;
  }
}

}  // namespace viapoint::rtde
