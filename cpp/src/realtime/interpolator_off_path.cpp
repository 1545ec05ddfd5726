// Off the path: a jog, by itself or in a pause, and the way back to the path after it.
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {

void Interpolator::jog(const JointVector& velocity) noexcept VIAPOINT_NONBLOCKING {
  if (may_be_jogged()) jog_.wish(velocity, jog_cycles_, position_);
}

void Interpolator::stop_jog() noexcept VIAPOINT_NONBLOCKING {
  if (jog_.active()) jog_.wish(JointVector::Zero(position_.size()), 0, position_);
}

bool Interpolator::may_be_jogged() const noexcept {
  if (motion_ == nullptr) return run_state_ != RunState::kFault;
  return wish_ == Wish::kPause &&
         (run_state_ == RunState::kPaused || run_state_ == RunState::kJogging);
}

RunState Interpolator::tick_jog(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  if (motion_ == nullptr) {
    shown_ = {0.0, 0.0, 0.0};
    move_ = -1;
  } else {
    off_path_ = true;
    if (wish_ != Wish::kPause) stop_jog();
    switch_outputs(false);
  }
  jog_.tick(setpoint);
  position_ = setpoint.q;
  setpoint.outputs = outputs_;
  run_state_ = motion_ == nullptr ? RunState::kIdle : RunState::kPaused;
  if (jog_.active()) run_state_ = RunState::kJogging;
  return run_state_;
}

RunState Interpolator::tick_return(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  const double share = wants_motion() ? override_ : 0.0;
  if (!return_.active() && share > 0.0) {
    const double tau = nominal(now_.tau);
    return_.begin(position_, motion_->pieces()[piece_].at(motion_->time_in(piece_, tau)).q);
  }
  bool rests = true;
  if (return_.active()) {
    return_.tick(share, setpoint);
    position_ = setpoint.q;
    setpoint.outputs = outputs_;
    rests = return_.rests() && share == 0.0;
    off_path_ = !return_.arrived();
    if (rests || !off_path_) return_.drop();
  } else {
    hold(setpoint);
  }
  if (is_stop()) {
    run_state_ = rests ? RunState::kStopped : RunState::kStopping;
    if (rests) motion_ = nullptr;
  } else {
    run_state_ = share > 0.0 ? RunState::kReturning
                 : rests     ? RunState::kPaused
                             : RunState::kPausing;
  }
  return run_state_;
}

}  // namespace viapoint
