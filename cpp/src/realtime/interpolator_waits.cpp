// Where a motion rests: at its end for more of it, between pieces for an input, and where a stop is
// left to it.
#include <algorithm>

#include "viapoint/profile/axis_move.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

/// A motion that is this little before a place to wait is there [s].
constexpr double kPlaceSlack = 1e-9;
/// A rest of the motion is as soon as a stop where it takes no more than this of its time.
constexpr double kAsSoon = 1.1;

}  // namespace

LinkFate Interpolator::lengthen(const MotionLink& link) noexcept VIAPOINT_NONBLOCKING {
  if (motion_ == nullptr) return LinkFate::kTooLate;
  // Who is about to go back may still do so, as far as the present motion reaches.
  const bool goes_back =
      direction_ == Direction::kBackward || (wish_ == Wish::kBackward && !link.begins_at_rest);
  if (goes_back || piece_ < link.dropped) return LinkFate::kNotYet;
  // A place that is its own but for rounding is the same place.
  const double same_until = link.same_until + kPlaceSlack;
  if (!waits_ && governor_.settled_at(now_) > same_until) {
    return now_.tau > same_until ? LinkFate::kTooLate : LinkFate::kNotYet;
  }
  if (waits_ && now_.tau > same_until) return LinkFate::kTooLate;
  // It has been beyond on the old way, and come back: outputs there are switched, and not again.
  if (farthest_ > same_until) return LinkFate::kTooLate;
  // At its end the arm rests, whatever rate it came with; what follows begins anew.
  const bool rests = waits_ || now_.tau >= motion_->duration();
  timed_outputs_.lengthen(link.motion->timed_changes(), link.dropped, link.shift, farthest_,
                          outputs_with(outputs_));
  if (link.dropped > 0) {
    const OutputEffect& passed = motion_->outputs_after(link.dropped - 1);
    outputs_before_ = (outputs_before_ & ~passed.changed) | passed.on;
  }
  gate_.lengthen(*link.motion, link.dropped);
  motion_ = link.motion;
  may_go_back_ = link.begins_at_rest;
  left_out_ += link.shift;
  now_.tau -= link.shift;
  shown_.tau -= link.shift;  // which a jog leaves as it is
  anchor_ -= link.shift;
  fresh_ -= link.shift;
  rest_place_ = rest_place_ <= same_until ? rest_place_ - link.shift : kNoPlace;
  farthest_piece_ -= link.dropped;
  farthest_ -= link.shift;
  lookahead_.lengthen(*motion_, link.same_until, link.shift, link.dropped);
  if (rests) {
    waits_ = false;
    rest_at(now_.tau);
    fresh_ = now_.tau;
  } else if (now_.rate == 0.0 && !governor_.changing()) {
    const bool is_fresh = fresh_ == now_.tau;
    rest_at(snapped(now_.tau));
    if (is_fresh) fresh_ = now_.tau;
  }
  enter_piece(motion_->piece_at(now_.tau));
  if (rests && step_move_ != kNoMove && motion_->pieces()[piece_].move != step_move_) {
    end_step(piece_);  // which was not known before
  }
  stop_at_gate();
  return LinkFate::kTaken;
}

/// Of each joint by itself, so that none on the path is shorter [s].
double Interpolator::shortest_stop() const noexcept VIAPOINT_NONBLOCKING {
  const JointState path = motion_->pieces()[piece_].at(motion_->time_in(piece_, nominal(now_.tau)));
  const double slope = direction_ == Direction::kForward ? now_.slope : -now_.slope;
  double longest = 0.0;
  for (int i = 0; i < limits_.joints(); ++i) {
    const AxisState now{0.0, path.qd[i] * now_.rate,
                        path.qdd[i] * now_.rate * now_.rate + path.qd[i] * slope, 0.0};
    const AxisLimits limits =
        AxisLimits::symmetric(limits_.velocity[i], limits_.acceleration[i], limits_.jerk[i]);
    AxisMove stop;
    if (quickest_velocity_change(now, {}, limits, stop) == MoveStatus::kSolved) {
      longest = std::max(longest, stop.total);
    }
  }
  return longest;
}

/// Where a stop that is wished may be left to the motion.
double Interpolator::place_to_rest() const noexcept VIAPOINT_NONBLOCKING {
  if (target() != 0.0 || (now_.rate == 0.0 && !governor_.changing())) return kNoPlace;
  const double place = lookahead_.next_rest(now_.tau);
  const double time = place < kNoPlace ? governor_.time_to(now_, place) : kNoPlace;
  const bool goes_there = rest_place_ < kNoPlace && time < kNoPlace;
  if (goes_there) return place;
  const bool may_be_soon = time <= kAsSoon * longest_stop_;  // which is cheap to ask
  return may_be_soon && time <= kAsSoon * shortest_stop() ? place : kNoPlace;
}

/// At rest where the motion ends for now.
RunState Interpolator::tick_waiting(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  shown_ = {motion_->duration(), 0.0, 0.0};
  run_state_ = classify_wait();
  switch_outputs(false);
  hold(setpoint);
  if (run_state_ == RunState::kStopped || run_state_ == RunState::kFinished) motion_ = nullptr;
  return run_state_;
}

/// At rest at the end of a motion of which more may come.
RunState Interpolator::classify_wait() const noexcept {
  if (is_stop()) return RunState::kStopped;
  if (!open_) return RunState::kFinished;  // there is nothing left to be paused
  return wants_motion() ? RunState::kWaiting : RunState::kPaused;
}

/// At rest where an input is waited for. When that is so, or was missed, the cycle is another's.
RunState Interpolator::tick_at_gate(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  if (wants_motion()) {
    const InputGate::Answer answer = gate_.ask(inputs_);
    if (answer == InputGate::Answer::kGoOn) {
      fresh_ = now_.tau;
      return tick_motion(setpoint);
    }
    input_missed_ = answer == InputGate::Answer::kTimedOut;
    run_state_ = input_missed_ ? RunState::kStopped : RunState::kWaiting;
  } else {
    run_state_ = is_stop() ? RunState::kStopped : RunState::kPaused;
  }
  switch_outputs(false);
  evaluate(0.0, setpoint);
  if (run_state_ == RunState::kStopped) motion_ = nullptr;
  return run_state_;
}

/// The arm gets no farther than where it is to wait; the path rests there.
void Interpolator::stop_at_gate() noexcept VIAPOINT_NONBLOCKING {
  if (direction_ == Direction::kBackward || gate_.waits()) return;
  const double place = gate_.place();
  if (now_.tau < place - kPlaceSlack) return;
  rest_at(place);
  gate_.arrive();
}

}  // namespace viapoint
