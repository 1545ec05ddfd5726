#include "viapoint/trajectory/trajectory.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "trajectory/trajectory_piece_check.hpp"

namespace viapoint {
Trajectory::Trajectory(std::vector<TrajectoryPiece> pieces, const JointLimits& limits)
    : pieces_(std::move(pieces)) {
  if (pieces_.empty()) {
    throw MotionError(ErrorCode::kBadArgument, "a trajectory needs at least one piece, got none");
  }
  const int joints = pieces_.front().joints;
  starts_.reserve(pieces_.size());
  for (size_t i = 0; i < pieces_.size(); ++i) {
    if (const auto fault = find_fault(pieces_[i], joints)) {
      throw MotionError(ErrorCode::kBadArgument,
                        "piece " + std::to_string(i) + " of the trajectory " + *fault);
    }
    starts_.push_back(duration_);
    duration_ += pieces_[i].duration;
  }
  if (limits.joints() != joints) {
    throw MotionError(ErrorCode::kBadArgument, "the trajectory has " + std::to_string(joints) +
                                                   " joints, its limits have " +
                                                   std::to_string(limits.joints()));
  }
  certificate_ = certify(pieces_, limits);
}

size_t Trajectory::piece_at(double t) const {
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), t);
  if (after == starts_.begin()) return 0;
  return static_cast<size_t>(std::distance(starts_.begin(), after)) - 1;
}

JointState Trajectory::at(double t) const {
  if (pieces_.empty()) return JointState::zero(0);
  const size_t i = piece_at(t);
  return pieces_[i].at(std::clamp(t - starts_[i], 0.0, pieces_[i].duration));
}

}  // namespace viapoint
