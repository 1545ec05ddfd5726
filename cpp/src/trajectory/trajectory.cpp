#include "viapoint/trajectory/trajectory.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "trajectory/trajectory_piece_check.hpp"
#include "viapoint/core/number_text.hpp"

namespace viapoint {
namespace {

/// @pre find_fault() found nothing
void add(const TrajectoryPiece& piece, OutputEffect& effect) {
  for (int i = 0; i < piece.outputs; ++i) {
    const OutputChange& change = piece.output[static_cast<size_t>(i)];
    const std::uint64_t bit = std::uint64_t{1} << change.index;
    effect.changed |= bit;
    effect.on = change.value ? effect.on | bit : effect.on & ~bit;
  }
}

/// @param seconds until the end of piece i
[[noreturn]] void refuse_length(double seconds, size_t i, const TrajectoryPiece& piece) {
  Problem problem;
  problem.code = ErrorCode::kBadArgument;
  problem.message = "the trajectory lasts " + number_text(seconds) +
                    " s up to the end of its piece " + std::to_string(i) + "; allowed are up to " +
                    number_text(Trajectory::kMostDuration) + " s";
  problem.ways_out = {"run it as several programs, one after the other",
                      "give speeds and waits nearer to what a machine does"};
  problem.move = piece.move;
  problem.value = seconds;
  problem.limit = Trajectory::kMostDuration;
  throw MotionError(problem);
}

/// Shorter than this share of a piece, what is left of it is rounding.
constexpr double kSliver = 1e-12;

}  // namespace

bool begins_before(const TrajectoryPiece& piece, double left) {
  return left > kSliver * piece.duration;
}

Trajectory::Trajectory(std::vector<TrajectoryPiece> pieces, const JointLimits& limits,
                       const std::optional<JointState>& from)
    : pieces_(std::move(pieces)) {
  if (pieces_.empty()) {
    throw MotionError(ErrorCode::kBadArgument, "a trajectory needs at least one piece, got none");
  }
  const int joints = pieces_.front().joints;
  starts_.reserve(pieces_.size());
  outputs_.reserve(pieces_.size());
  for (size_t i = 0; i < pieces_.size(); ++i) {
    if (const auto fault = find_fault(pieces_[i], joints)) {
      throw MotionError(ErrorCode::kBadArgument,
                        "piece " + std::to_string(i) + " of the trajectory " + *fault);
    }
    index(pieces_[i]);
    if (duration_ > kMostDuration) refuse_length(duration_, i, pieces_[i]);
  }
  if (limits.joints() != joints) {
    throw MotionError(ErrorCode::kBadArgument, "the trajectory has " + std::to_string(joints) +
                                                   " joints, its limits have " +
                                                   std::to_string(limits.joints()));
  }
  timed_ = TimedChanges(pieces_, starts_);
  certificate_ = certify(pieces_, limits, from);
}

void Trajectory::index(const TrajectoryPiece& piece) {
  if (piece.wait.any()) waits_.push_back(starts_.size());
  starts_.push_back(duration_);
  duration_ += piece.duration;
  OutputEffect outputs = outputs_.empty() ? OutputEffect{} : outputs_.back();
  add(piece, outputs);
  outputs_.push_back(outputs);
}

Trajectory Trajectory::continued(size_t dropped, double leave, const Trajectory& next) const {
  Trajectory whole;
  whole.certificate_ = next.certificate_;
  double left = leave - starts_[dropped];
  for (size_t i = dropped; i < pieces_.size(); ++i) {
    TrajectoryPiece piece = pieces_[i];
    if (!begins_before(piece, left)) break;
    const double share = left / piece.duration;
    left -= piece.duration;
    if (share < 1.0 - kSliver) piece = piece.until(share * piece.duration);
    whole.pieces_.push_back(piece);
  }
  whole.pieces_.insert(whole.pieces_.end(), next.pieces_.begin(), next.pieces_.end());
  for (const TrajectoryPiece& piece : whole.pieces_) whole.index(piece);
  whole.timed_ =
      TimedChanges(whole.pieces_, whole.starts_, timed_.outputs() | next.timed_.outputs());
  return whole;
}

size_t Trajectory::piece_at(double t) const {
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), t);
  if (after == starts_.begin()) return 0;
  return static_cast<size_t>(std::distance(starts_.begin(), after)) - 1;
}

JointState Trajectory::at(double t) const {
  if (pieces_.empty()) return JointState::zero(0);
  const size_t i = piece_at(t);
  return pieces_[i].at(time_in(i, t));
}

}  // namespace viapoint
