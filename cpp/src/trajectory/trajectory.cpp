#include "viapoint/trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>

namespace viapoint {
namespace {

[[noreturn]] void refuse(size_t piece, const std::string& what) {
  throw MotionError(ErrorCode::kBadArgument,
                    "piece " + std::to_string(piece) + " of the trajectory " + what);
}

bool all_finite(const TrajectoryPiece& piece) {
  for (const auto& row : piece.path) {
    for (size_t i = 0; i < static_cast<size_t>(piece.joints); ++i) {
      if (!std::isfinite(row[i])) return false;
    }
  }
  return std::ranges::all_of(piece.timing, [](double c) { return std::isfinite(c); });
}

void check_piece(const TrajectoryPiece& piece, size_t index, int joints) {
  if (piece.joints < 1 || piece.joints > kMaxJoints) {
    refuse(index, "has " + std::to_string(piece.joints) + " joints; allowed are 1 to " +
                      std::to_string(kMaxJoints));
  }
  if (piece.joints != joints) {
    refuse(index, "has " + std::to_string(piece.joints) + " joints, where the first has " +
                      std::to_string(joints));
  }
  if (!(piece.duration > 0.0) || !std::isfinite(piece.duration)) {
    std::ostringstream text;
    text << "lasts " << piece.duration << " s; it must be more than 0 and finite";
    refuse(index, text.str());
  }
  if (!all_finite(piece)) refuse(index, "has a coefficient that is not a finite number");
  if (piece.outputs < 0 || piece.outputs > kMaxOutputsAPiece) {
    refuse(index, "changes " + std::to_string(piece.outputs) + " outputs; allowed are 0 to " +
                      std::to_string(kMaxOutputsAPiece));
  }
}

}  // namespace

Trajectory::Trajectory(std::vector<TrajectoryPiece> pieces, const JointLimits& limits)
    : pieces_(std::move(pieces)) {
  if (pieces_.empty()) {
    throw MotionError(ErrorCode::kBadArgument, "a trajectory needs at least one piece, got none");
  }
  const int joints = pieces_.front().joints;
  starts_.reserve(pieces_.size());
  for (size_t i = 0; i < pieces_.size(); ++i) {
    check_piece(pieces_[i], i, joints);
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
