/// @file
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "viapoint/drives/guiding_hand.hpp"
#include "viapoint/remote/arm_host.hpp"

namespace viapoint::controller {

/// A hand that an operator lends: where it takes a simulated arm comes part by part.
/// Threads: any. Real-time: not.
class HandMotion {
 public:
  /// Ten minutes at 500 Hz.
  static constexpr std::size_t kMaxPositions = 300'000;
  /// Where a hand takes an arm it stands within this of it [rad or m], as encoders may step.
  static constexpr double kReach = 1e-3;

  /// @param hand null where the drive is a real one, whose hand is the world's
  explicit HandMotion(std::shared_ptr<GuidingHand> hand) : hand_(std::move(hand)) {}

  /// @param offset how many positions came before; 0 forgets what there is
  /// @throws MotionError(kBadArgument) for another offset, beyond kMaxPositions, and for a real
  ///   drive
  void add(std::size_t offset, std::vector<JointVector> positions);
  /// Takes the arm through what was added, a position a cycle, from the next one on.
  /// @throws MotionError(kBusy) where the arm moves or is guided; kBadArgument where it stands
  ///   farther than kReach from the first position, for none, and for a real drive; what
  ///   ArmHost::admit_hand does
  void begin(ArmHost& host, const std::string& token);
  void let_go();

 private:
  [[nodiscard]] GuidingHand& hand() const;

  std::shared_ptr<GuidingHand> hand_;
  std::mutex mutex_;
  std::vector<JointVector> pending_;
};

}  // namespace viapoint::controller
