#include "viapoint/realtime/interpolator.hpp"

#include <algorithm>

namespace viapoint {
namespace {

/// A motion that ends this little after a cycle ends with it [s].
constexpr double kEndSlack = 1e-9;
/// New cells of the look-ahead a cycle: two are used up at full rate, the rest fills the window in
/// the first half second.
constexpr int kCellsACycle = 8;

}  // namespace

Interpolator::Interpolator(const JointLimits& limits, std::chrono::nanoseconds cycle,
                           const JointVector& position)
    : cycle_(std::chrono::duration<double>(cycle).count()),
      governor_(limits, cycle_),
      jog_(limits, cycle_),
      jog_cycles_(static_cast<int>(kJogLease / cycle) + 1),
      lookahead_(limits, governor_.cell()),
      position_(position) {
  shown_ = {0.0, 0.0, 0.0};
}

void Interpolator::begin(const Trajectory& motion) noexcept VIAPOINT_NONBLOCKING {
  motion_ = &motion;
  wish_ = Wish::kRun;
  // At rest any rate is as good as any other: the motion starts at the one wanted.
  now_ = {0.0, override_, 0.0};
  anchor_ = 0.0;
  since_anchor_ = 0;
  governor_.reset();
  lookahead_.begin(motion);
  run_state_ = RunState::kRunning;
  outputs_before_ = outputs_;
  enter_piece(0);
}

void Interpolator::set_override(double share) noexcept VIAPOINT_NONBLOCKING {
  override_ = std::clamp(share, 0.0, 1.0);
}

void Interpolator::wish(Wish wish) noexcept VIAPOINT_NONBLOCKING {
  if (wish_ != Wish::kStop) wish_ = wish;
}

void Interpolator::abandon() noexcept VIAPOINT_NONBLOCKING {
  motion_ = nullptr;
  jog_.abandon();
  run_state_ = RunState::kFault;
}

void Interpolator::jog(const JointVector& velocity) noexcept VIAPOINT_NONBLOCKING {
  if (motion_ != nullptr || run_state_ == RunState::kFault) return;
  jog_.wish(velocity, jog_cycles_, position_);
}

double Interpolator::target() const noexcept { return wish_ == Wish::kRun ? override_ : 0.0; }

RunState Interpolator::tick(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  setpoint.cycle = cycles_++;
  if (motion_ == nullptr && jog_.active()) {
    shown_ = {0.0, 0.0, 0.0};
    move_ = -1;
    jog_.tick(setpoint);
    position_ = setpoint.q;
    setpoint.outputs = outputs_;
    run_state_ = jog_.active() ? RunState::kJogging : RunState::kIdle;
    return run_state_;
  }
  if (motion_ == nullptr) {
    shown_.rate = 0.0;
    setpoint.q = position_;
    setpoint.qd.setZero(position_.size());
    setpoint.qdd.setZero(position_.size());
    setpoint.qddd.setZero(position_.size());
    setpoint.outputs = outputs_;
    return run_state_;
  }
  const bool untouched = now_.tau == 0.0 && !governor_.changing();
  if (untouched) {
    now_.rate = target();
    since_anchor_ = 0;
  }

  looked_at_ = lookahead_.advance(now_.tau, kCellsACycle, kPiecesACycle);
  const double curvature = governor_.decide(now_, target(), lookahead_);
  evaluate(curvature, setpoint);
  run_state_ = classify();
  if (run_state_ == RunState::kFinished || run_state_ == RunState::kStopped) {
    motion_ = nullptr;
  } else {
    move_on();
  }
  return run_state_;
}

void Interpolator::describe(const Setpoint& setpoint,
                            LogRecord& record) const noexcept VIAPOINT_NONBLOCKING {
  record.nominal_time = nominal_time();
  record.rate = rate();
  record.move = move();
  record.state = state();
  record.outputs = setpoint.outputs;
  record.q = setpoint.q;
  record.qd = setpoint.qd;
  record.qdd = setpoint.qdd;
  record.qddd = setpoint.qddd;
}

RunState Interpolator::classify() const noexcept {
  if (now_.tau >= motion_->duration()) return RunState::kFinished;
  const bool at_rest = now_.rate == 0.0 && !governor_.changing();
  if (wish_ == Wish::kStop) return at_rest ? RunState::kStopped : RunState::kStopping;
  if (target() > 0.0) return RunState::kRunning;
  return at_rest ? RunState::kPaused : RunState::kPausing;
}

void Interpolator::evaluate(double curvature, Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  const TrajectoryPiece& piece = motion_->pieces()[piece_];
  const JointState path = piece.at(motion_->time_in(piece_, now_.tau));
  const double rate = now_.rate, slope = now_.slope;
  setpoint.q = path.q;
  setpoint.qd = path.qd * rate;
  setpoint.qdd = path.qdd * (rate * rate) + path.qd * slope;
  setpoint.qddd =
      path.qddd * (rate * rate * rate) + path.qdd * (3.0 * rate * slope) + path.qd * curvature;
  setpoint.outputs = outputs_;
  position_ = path.q;
  move_ = piece.move;
  shown_ = now_;
}

void Interpolator::move_on() noexcept VIAPOINT_NONBLOCKING {
  if (governor_.changing()) {
    now_ = governor_.advance(now_);
    anchor_ = now_.tau;
    since_anchor_ = 0;
  } else {
    ++since_anchor_;
    now_.tau = anchor_ + static_cast<double>(since_anchor_) * cycle_ * now_.rate;
  }
  if (now_.tau > motion_->duration() - kEndSlack) now_.tau = motion_->duration();
  enter_piece(motion_->piece_at(now_.tau));
}

void Interpolator::enter_piece(std::size_t piece) noexcept VIAPOINT_NONBLOCKING {
  piece_ = piece;
  const OutputEffect& effect = motion_->outputs_after(piece);
  outputs_ = (outputs_before_ & ~effect.changed) | effect.on;
}

}  // namespace viapoint
