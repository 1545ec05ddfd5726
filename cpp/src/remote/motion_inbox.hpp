/// @file
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// A motion that comes part by part. Threads: one at a time.
class MotionInbox {
 public:
  /// As ArmHost::add_pieces.
  void add(std::size_t offset, std::vector<TrajectoryPiece> part);
  /// What has come, and forgets it.
  [[nodiscard]] std::vector<TrajectoryPiece> take() { return std::exchange(pieces_, {}); }
  void clear() { pieces_ = {}; }

 private:
  std::vector<TrajectoryPiece> pieces_;
};

}  // namespace viapoint
