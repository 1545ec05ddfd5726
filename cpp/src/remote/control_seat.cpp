#include "viapoint/remote/control_seat.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <random>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"

namespace viapoint {
namespace {

/// 128 bits of the system's randomness, so that nobody comes upon another one's token.
std::string new_token() {
  std::random_device source;
  std::string token;
  for (int word = 0; word < 4; ++word) {
    std::array<char, 9> digits{};
    std::snprintf(digits.data(), digits.size(), "%08x", source());
    token += digits.data();
  }
  return token;
}

}  // namespace

std::string ControlSeat::take(const std::string& name, Time now) {
  if (taken()) {
    throw NotInControl("\"" + name_ + "\" has control of the arm",
                       {"wait until it is given up", "connect to watch only"});
  }
  token_ = new_token();
  name_ = name;
  heard_ = now;
  return token_;
}

void ControlSeat::require(const std::string& token) const {
  if (holds(token)) return;
  if (!token.empty() && token == last_token_) {
    throw NotInControl(loss_,
                       {"connect again, look at what the arm does, then resume or stop its run"});
  }
  throw NotInControl("this connection has no control of the arm",
                     {"connect with control, not to watch only"});
}

void ControlSeat::beat(const std::string& token, Time now) {
  require(token);
  heard_ = now;
}

void ControlSeat::leave(const std::string& token) {
  require(token);
  loss_ = "\"" + name_ + "\" gave up control";
  vacate();
}

bool ControlSeat::expire(Time now) {
  if (!taken() || now < *deadline()) return false;
  loss_ = "control was lost: nothing was heard of \"" + name_ + "\" for " +
          number_text(std::chrono::duration<double>(silence_).count()) + " s";
  vacate();
  return true;
}

std::optional<ControlSeat::Time> ControlSeat::deadline() const {
  if (!taken()) return std::nullopt;
  return heard_ + std::chrono::duration_cast<Time::duration>(silence_);
}

void ControlSeat::vacate() {
  last_token_ = std::exchange(token_, {});
  name_.clear();
}

}  // namespace viapoint
