#include "planning/section_builder.hpp"

#include <cstdio>
#include <iterator>
#include <utility>

#include "planning/corner_fit.hpp"
#include "planning/path_cut.hpp"
#include "planning/path_timer.hpp"

namespace viapoint::planning {
namespace {

/// A leg between two corners gives each up to half; towards a stop nearly all of it.
constexpr double kShareBetweenCorners = 0.5;
constexpr double kShareTowardsStop = 0.9;

void append(JointPath& path, const JointPath& more) {
  for (const JointPiece& piece : more.pieces()) path.append(piece);
}

bool wants_corner(const Leg& leg) { return leg.options.zone.kind != ZoneKind::kFine; }

}  // namespace

void SectionBuilder::add(Leg leg) {
  if (next_) turn(wants_corner(*next_));
  if (!leg_) {
    tail_ = leg.path;
    leg_ = std::move(leg);
  } else {
    next_ = std::move(leg);
  }
  if (!wants_corner(*leg_)) {
    finish();
  } else if (next_ && !wants_corner(*next_)) {
    turn(false);
    if (!wants_corner(*leg_)) finish();
  }
}

void SectionBuilder::end() {
  if (next_) turn(false);
  if (leg_) finish();
}

std::vector<SectionPart> SectionBuilder::take() { return std::exchange(parts_, {}); }

JointPath SectionBuilder::certain() const {
  if (!leg_) return {};
  return cut(tail_, 0.0, (1.0 - kShareTowardsStop) * tail_.length());
}

SectionPart& SectionBuilder::part() {
  if (parts_.empty() || parts_.back().ends) parts_.emplace_back();
  return parts_.back();
}

void SectionBuilder::turn(bool corner_after) {
  if (!round(corner_after)) {
    finish();
    return;
  }
  leg_ = std::move(next_);
  next_.reset();
}

bool SectionBuilder::round(bool corner_after) {
  tell_merged();
  const Leg& after = *next_;
  const double room_before = kShareTowardsStop * tail_.length();
  const double room_after =
      (corner_after ? kShareBetweenCorners : kShareTowardsStop) * after.path.length();
  Corner corner = fit_corner(robot_, *leg_, tail_, after, room_before, room_after);
  CornerOutcome outcome;
  outcome.move = leg_->step;
  outcome.asked = leg_->options.zone;
  outcome.reason = corner.reason;
  outcome.angle_rules = corner.angle_rules;
  if (!corner.possible) {
    stop(std::move(outcome));
    return false;
  }
  const JointPath head = cut(tail_, 0.0, tail_.length() - corner.cut_before);
  JointPath rest = cut(after.path, corner.cut_after, after.path.length());
  // A process goes on through a corner, whatever that costs.
  const bool process = leg_->tool_limits().hold_speed && after.tool_limits().hold_speed;
  if (!process && !surely_pays(corner, tail_, after.path)) {
    const double gain = gain_of(head, corner.blend, rest);
    if (gain <= 0.0) {
      char reason[96];
      std::snprintf(reason, sizeof reason, "stopping at the point is quicker by %.1f ms",
                    -1e3 * gain);
      outcome.reason = reason;
      stop(std::move(outcome));
      return false;
    }
  }
  append(part().path, head);
  append_blend(corner.blend, leg_->step, after.step);
  tail_ = std::move(rest);
  outcome.used = corner.used;
  outcome.used_angle = corner.used_angle;
  outcome.cut = corner.tool_deviation;
  part().corners.push_back(std::move(outcome));
  return true;
}

void SectionBuilder::stop(CornerOutcome outcome) {
  outcome.stopped = true;
  part().corners.push_back(std::move(outcome));
}

/// How much quicker the two legs are with the corner than with a stop [s]. Each is timed from rest
/// to rest: the neighbours are the same in both.
double SectionBuilder::gain_of(const JointPath& head, const JointPiece& blend,
                               const JointPath& rest) const {
  JointPath rounded = head;
  rounded.append(blend);
  append(rounded, rest);
  const double with_stop = duration_at_rest(robot_, tail_) + duration_at_rest(robot_, next_->path);
  return with_stop - duration_at_rest(robot_, rounded);
}

/// In two halves, so that the move under way changes in the middle of the corner.
void SectionBuilder::append_blend(const JointPiece& blend, int step_before, int step_after) {
  JointPiece first = blend.part(0.0, 0.5 * blend.length);
  JointPiece second = blend.part(0.5 * blend.length, blend.length);
  first.move = step_before;
  second.move = step_after;
  part().path.append(std::move(first));
  part().path.append(std::move(second));
}

void SectionBuilder::tell_merged() {
  std::vector<CornerOutcome> points = std::exchange(leg_->merged.points, {});
  auto& corners = part().corners;
  corners.insert(corners.end(), std::make_move_iterator(points.begin()),
                 std::make_move_iterator(points.end()));
}

void SectionBuilder::finish() {
  tell_merged();
  append(part().path, tail_);
  part().ends = true;
  leg_ = std::move(next_);
  next_.reset();
  tail_ = leg_ ? leg_->path : JointPath();
}

}  // namespace viapoint::planning
