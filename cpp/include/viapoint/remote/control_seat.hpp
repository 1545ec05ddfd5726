/// @file
/// Who may move the arm: one operator at a time, for as long as he shows that he is there.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "viapoint/core/error.hpp"

namespace viapoint {

/// Somebody else has control of the arm, or it was lost.
class NotInControl : public MotionError {
 public:
  explicit NotInControl(std::string message, std::vector<std::string> ways_out = {})
      : MotionError(ErrorCode::kBusy, std::move(message), std::move(ways_out)) {}
};

/// The one seat in front of the arm. Who takes it is given a token, which his commands carry, and
/// has to beat with it: after a silence the seat is free again. Time is told, not looked up, so
/// that tests need no clock. Threads: one at a time. Real-time: not.
class ControlSeat {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @param silence after which control is lost. @pre silence > 0
  explicit ControlSeat(std::chrono::nanoseconds silence) : silence_(silence) {}

  /// Takes the free seat, and returns the token.
  /// @param name what others are told about who has control
  /// @throws NotInControl when it is taken
  [[nodiscard]] std::string take(const std::string& name, Time now);
  /// @throws NotInControl, with how control was lost if this token had it last
  void require(const std::string& token) const;
  /// The operator is there. @throws as require()
  void beat(const std::string& token, Time now);
  /// The operator leaves. @throws as require()
  void leave(const std::string& token);
  /// Frees the seat of an operator who was silent for too long; true when it did.
  [[nodiscard]] bool expire(Time now);

  /// True where this token has control.
  [[nodiscard]] bool holds(const std::string& token) const { return taken() && token == token_; }
  [[nodiscard]] bool taken() const { return !token_.empty(); }
  /// When control will be lost if nothing is heard until then.
  [[nodiscard]] std::optional<Time> deadline() const;
  /// Who has control; empty: nobody.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// How control was lost last, in a sentence; empty: it never was.
  [[nodiscard]] const std::string& loss() const { return loss_; }

 private:
  void vacate();

  std::chrono::nanoseconds silence_;
  std::string token_, name_;
  std::string last_token_;  ///< of the operator before
  std::string loss_;
  Time heard_;
};

}  // namespace viapoint
