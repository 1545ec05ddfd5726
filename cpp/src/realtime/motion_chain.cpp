#include "realtime/motion_chain.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"

namespace viapoint {
namespace {

/// A time this near the motion's end is its end [s].
constexpr double kEndSlack = 1e-9;

}  // namespace

MotionChain::MotionChain(std::shared_ptr<const Trajectory> first, const JointLimits& limits)
    : limits_(limits), duration_(first->duration()) {
  present_.motion = std::move(first);
  present_.rested = {0};
}

const MotionLink* MotionChain::lengthen(const Trajectory& next, double leave, double now) {
  const Trajectory& motion = *present_.motion;
  double at = present_.last_start - present_.start + leave;
  if (!(leave >= 0.0 && at > 0.0 && at <= motion.duration() + kEndSlack)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "a motion is to be left at " + number_text(leave) + " s of its " +
                          number_text(motion.duration() + present_.start - present_.last_start) +
                          " s");
  }
  const bool from_rest = at >= motion.duration() - kEndSlack;
  if (from_rest) at = motion.duration();
  const Certificate proof = certify(next.pieces(), limits_, motion.at(at));
  if (!proof.holds()) throw MotionError(proof.problems.front());

  const std::size_t piece_left =
      from_rest ? motion.pieces().size() - 1 : motion.piece_at(std::max(0.0, at - kEndSlack));
  const std::size_t piece_now = motion.piece_at(std::max(0.0, now - present_.start));
  const std::size_t dropped = first_kept(piece_now, piece_left);
  offered_ = {};
  offered_.motion = std::make_shared<const Trajectory>(motion.continued(dropped, at, next));
  offered_.told.motion = offered_.motion.get();
  offered_.told.dropped = dropped;
  offered_.told.shift = motion.start_of(dropped);
  offered_.told.same_until = at;
  offered_.start = present_.start + offered_.told.shift;
  offered_.last_start = present_.start + at;
  for (const std::size_t piece : present_.rested) {
    if (piece >= dropped) offered_.rested.push_back(piece - dropped);
  }
  if (from_rest) offered_.rested.push_back(offered_.motion->pieces().size() - next.pieces().size());
  offered_.told.begins_at_rest = !offered_.rested.empty() && offered_.rested.front() == 0;
  return &offered_.told;
}

std::size_t MotionChain::first_kept(std::size_t piece_now, std::size_t piece_left) const {
  const std::size_t behind = std::min(piece_now, piece_left);
  const std::size_t oldest = behind > kKept ? behind - kKept : 0;
  for (const std::size_t rested : present_.rested) {
    if (rested >= oldest && rested <= behind) return rested;
  }
  return oldest == 0 ? 0 : behind;
}

void MotionChain::settle(LinkFate fate) {
  if (offered_.motion == nullptr || fate == LinkFate::kNotYet) return;
  if (fate == LinkFate::kTaken) {
    present_ = std::move(offered_);
    duration_.store(present_.start + present_.motion->duration(), std::memory_order_relaxed);
  }
  offered_ = {};
}

}  // namespace viapoint
