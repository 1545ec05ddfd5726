#include "planning/pending_outputs.hpp"

#include <algorithm>

namespace viapoint::planning {
namespace {

/// Times that differ by less are the same [s].
constexpr double kMoment = 1e-9;

}  // namespace

void PendingOutputs::leave(std::span<const TrajectoryPiece> last, double leave) {
  std::vector<double> left;  // when each piece of it begins, before that
  for (double time = 0.0; const TrajectoryPiece& piece : last) {
    left.push_back(leave - time);
    time += piece.duration;
  }
  // At the very moment, but for rounding, the next chunk changes it, too.
  std::erase_if(pending_, [&](const Pending& pending) {
    return pending.piece && left[*pending.piece] > kMoment;
  });
  for (Pending& pending : pending_) {
    pending.in_tail = pending.piece.has_value();
    pending.piece.reset();
    if (!pending.in_tail) move_point(pending.output, last, leave);
  }
}

void PendingOutputs::attach(std::vector<TrajectoryPiece>& pieces, std::vector<ToolLimits>& tool,
                            const Surroundings& around) {
  std::vector<Output> outputs;
  for (const Pending& pending : pending_) outputs.push_back(pending.output);
  const auto attached = attach_outputs(pieces, tool, outputs, around);
  for (std::size_t i = 0; i < attached.size(); ++i) pending_[i].piece = attached[i];
}

void PendingOutputs::hand_out(const Trajectory& motion, double left) {
  due_after_before_ = due_after_;
  due_after_ -= motion.duration() - left;
  for (const Pending& pending : pending_) {
    if (!pending.piece) continue;
    const double at = motion.start_of(*pending.piece) + pending.output.change.time;
    due_after_ = std::max(due_after_, at - motion.duration());
  }
  due_after_ = std::max(due_after_, 0.0);
}

void PendingOutputs::miss() {
  // What the end of the chunk before has switched is switched.
  std::erase_if(pending_, [](const Pending& pending) { return pending.in_tail; });
  for (Pending& pending : pending_) pending.piece.reset();
  due_after_ = due_after_before_;
}

bool PendingOutputs::all_come() const {
  return !(due_after_ > 0.0) && std::ranges::all_of(pending_, [](const Pending& pending) {
    return pending.piece.has_value();
  });
}

double PendingOutputs::latest() const {
  double latest = due_after_;
  for (const Pending& pending : pending_) latest = std::max(latest, pending.output.change.time);
  return latest;
}

}  // namespace viapoint::planning
