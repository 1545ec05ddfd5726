/// @file
/// One client's conversation, without the network.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rtde/arm_view.hpp"
#include "rtde/variables.hpp"
#include "rtde/wire.hpp"
#include "viapoint/rtde/rtde_arm.hpp"

namespace viapoint::rtde {

/// What a client may take up at most.
inline constexpr std::size_t kMostPackageBytes = 4096;  ///< that a client sends
inline constexpr std::size_t kMostVariables = 200;      ///< of one recipe
inline constexpr std::size_t kMostInputRecipes = 100;

/// Answers what a client sends, and acts on it. Protocol version 2 only. Threads: one.
class Session {
 public:
  /// @param arm outlives the session; @param cycle the loop's [s]
  Session(RtdeArm& arm, double cycle) : arm_(arm), cycle_(cycle) {}

  /// Bytes as they come, in pieces of any length. After a breach of the protocol nothing more is
  /// read. Returns the answers.
  [[nodiscard]] Bytes receive(std::string_view bytes);
  /// The client has broken the protocol: it is told why, and then the connection has to end.
  [[nodiscard]] bool is_broken() const { return is_broken_; }
  /// True once client and server agree about the protocol.
  [[nodiscard]] bool has_greeted() const { return has_greeted_; }

  /// True between start and pause.
  [[nodiscard]] bool is_started() const { return is_started_; }
  /// True when it is time for the client's next package. @param time of the view [s]
  [[nodiscard]] bool is_due(double time) const {
    return is_started_ && time + 0.5 * cycle_ >= due_;
  }
  /// The client's package, for now. @pre is_due()
  [[nodiscard]] Bytes data(const ArmView& view);

 private:
  void answer(PackageType type, std::string_view payload);
  /// Ends the conversation.
  void refuse(std::string_view why);
  void tell(std::string_view message, std::uint8_t level);
  void handle(PackageType type, std::string_view payload);
  void greet(std::string_view payload);
  void set_up_outputs(std::string_view payload);
  void set_up_inputs(std::string_view payload);
  void take_data(std::string_view payload);

  RtdeArm& arm_;
  double cycle_;
  Bytes received_;  ///< the beginning of a package
  Bytes answers_;
  bool has_greeted_ = false, is_broken_ = false, is_started_ = false;
  std::vector<const OutputVariable*> outputs_;
  double period_ = 0.0, due_ = 0.0;                         ///< [s]
  std::vector<std::vector<const InputVariable*>> recipes_;  ///< the first has number 1
};

}  // namespace viapoint::rtde
