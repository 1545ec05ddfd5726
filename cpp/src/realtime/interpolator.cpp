#include "viapoint/realtime/interpolator.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint {
namespace {

/// A motion that ends this little after a cycle ends with it [s].
constexpr double kEndSlack = 1e-9;
/// New cells of the look-ahead a cycle: two are used up at full rate, the rest fills the window in
/// the first half second.
constexpr int kCellsACycle = 8;
/// Rates below these shares of the limits are those of a path at rest, but for rounding.
constexpr double kRestShare = 1e-6;

}  // namespace

Interpolator::Interpolator(const JointLimits& limits, std::chrono::nanoseconds cycle,
                           const JointVector& position)
    : limits_(limits),
      cycle_(std::chrono::duration<double>(cycle).count()),
      governor_(limits, cycle_),
      jog_(limits, cycle_),
      jog_cycles_(static_cast<int>(kJogLease / cycle) + 1),
      lookahead_(limits, governor_.cell()),
      return_(limits, cycle_),
      timed_outputs_(cycle_),
      gate_(cycle_),
      position_(position) {
  shown_ = {0.0, 0.0, 0.0};
  // From any velocity, however it is accelerated: three times up or down to a limit, and between.
  for (int i = 0; i < limits.joints(); ++i) {
    longest_stop_ = std::max(longest_stop_, limits.velocity[i] / limits.acceleration[i] +
                                                3.0 * limits.acceleration[i] / limits.jerk[i]);
  }
}

void Interpolator::begin(const Trajectory& motion, bool open) noexcept VIAPOINT_NONBLOCKING {
  motion_ = &motion;
  open_ = open;
  waits_ = false;
  may_go_back_ = true;
  fresh_ = 0.0;
  left_out_ = 0.0;
  wish_ = Wish::kRun;
  direction_ = Direction::kForward;
  off_path_ = false;
  rest_place_ = kNoPlace;
  return_.drop();
  // At rest any rate is as good as any other: the motion starts at the one wanted.
  now_ = {0.0, override_, 0.0};
  anchor_ = 0.0;
  since_anchor_ = 0;
  governor_.reset();
  lookahead_.begin(motion);
  run_state_ = RunState::kRunning;
  outputs_before_ = outputs_;
  farthest_piece_ = 0;
  farthest_ = 0.0;
  timed_outputs_.begin(motion.timed_changes(), outputs_);
  gate_.begin(motion);
  input_missed_ = false;
  enter_piece(0);
  stop_at_gate();
}

double Interpolator::settled_time() const noexcept VIAPOINT_NONBLOCKING {
  if (motion_ == nullptr) return 0.0;
  return left_out_ +
         (direction_ == Direction::kForward ? governor_.settled_at(now_) : motion_->duration());
}

void Interpolator::set_override(double share) noexcept VIAPOINT_NONBLOCKING {
  override_ = share < kLeastOverride ? 0.0 : std::min(share, 1.0);
}

void Interpolator::wish(Wish wish) noexcept VIAPOINT_NONBLOCKING {
  if (is_stop() && wish != Wish::kRelease) return;
  wish_ = wish == Wish::kBackward && !may_go_back_ ? Wish::kPause : wish;
  step_move_ = kNoMove;
}

void Interpolator::stand_at(const JointVector& position) noexcept VIAPOINT_NONBLOCKING {
  if (!active() && !jogging()) position_ = position;
}

void Interpolator::abandon() noexcept VIAPOINT_NONBLOCKING {
  motion_ = nullptr;
  jog_.abandon();
  run_state_ = RunState::kFault;
}

bool Interpolator::is_stop() const noexcept {
  return wish_ == Wish::kStop || wish_ == Wish::kRelease;
}

bool Interpolator::wants_motion() const noexcept {
  if (wish_ == Wish::kPause || is_stop()) return false;
  const bool is_at_start = direction_ == Direction::kBackward && now_.tau >= motion_->duration();
  return override_ > 0.0 && !(wish_ == Wish::kBackward && is_at_start);
}

double Interpolator::target() const noexcept {
  const auto wanted = wish_ == Wish::kBackward ? Direction::kBackward : Direction::kForward;
  return wants_motion() && direction_ == wanted ? override_ : 0.0;
}

/// The beginning of a piece for what is that but for rounding: a place belongs to what comes next.
double Interpolator::snapped(double tau) const noexcept VIAPOINT_NONBLOCKING {
  const double begin = motion_->start_of(motion_->piece_at(tau + kEndSlack));
  return std::abs(begin - tau) < kEndSlack ? begin : tau;
}

/// From a time along the way to the nominal one, and back.
double Interpolator::nominal(double way) const noexcept {
  return direction_ == Direction::kForward ? way : std::max(0.0, motion_->duration() - way);
}

RunState Interpolator::tick(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  setpoint.cycle = cycles_++;
  if (jog_.active()) return tick_jog(setpoint);
  if (motion_ == nullptr) {
    shown_.rate = 0.0;
    hold(setpoint);
    return run_state_;
  }
  if (off_path_) {
    switch_outputs(false);
    return tick_return(setpoint);
  }
  if (waits_ && !(wants_motion() && wish_ == Wish::kBackward)) return tick_waiting(setpoint);
  waits_ = false;
  if (gate_.waits() && !(wants_motion() && wish_ == Wish::kBackward)) return tick_at_gate(setpoint);
  gate_.leave();
  return tick_motion(setpoint);
}

void Interpolator::hold(Setpoint& setpoint) const noexcept VIAPOINT_NONBLOCKING {
  setpoint.q = position_;
  setpoint.qd.setZero(position_.size());
  setpoint.qdd.setZero(position_.size());
  setpoint.qddd.setZero(position_.size());
  setpoint.outputs = outputs_;
}

RunState Interpolator::tick_motion(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  turn_where_wanted();
  const bool untouched =
      now_.tau == fresh_ && direction_ == Direction::kForward && !governor_.changing();
  if (untouched) {
    now_.rate = target();
    anchor_ = now_.tau;  // it may have come here at speed
    since_anchor_ = 0;
  }
  if (wish_ == Wish::kStep && step_move_ == kNoMove && direction_ == Direction::kForward) {
    step_move_ = motion_->pieces()[piece_].move;
  }

  looked_at_ = lookahead_.advance(now_.tau, kCellsACycle, kPiecesACycle);
  rest_place_ = place_to_rest();
  const double curvature =
      rest_place_ < kNoPlace ? governor_.keep() : governor_.decide(now_, target(), lookahead_);
  run_state_ = classify();
  switch_outputs(direction_ == Direction::kForward);
  evaluate(curvature, setpoint);
  if (run_state_ == RunState::kFinished || run_state_ == RunState::kStopped) {
    motion_ = nullptr;
  } else if (ends_here()) {
    waits_ = true;
    rest_at(motion_->duration());
  } else {
    move_on();
  }
  return run_state_;
}

void Interpolator::switch_outputs(bool is_ahead) noexcept VIAPOINT_NONBLOCKING {
  const double until = std::min(gate_.place(), rest_place_);
  const TimedOutputs::Progress progress{farthest_, until, is_ahead, now_};
  std::uint64_t timed = timed_outputs_.tick(progress, governor_);
  if (run_state_ == RunState::kFinished) timed = timed_outputs_.end();
  outputs_ = outputs_with(timed);
}

/// Outputs that are told times as they are in `timed`, the others as the motion has changed them.
std::uint64_t Interpolator::outputs_with(std::uint64_t timed) const noexcept VIAPOINT_NONBLOCKING {
  const OutputEffect& effect = motion_->outputs_after(farthest_piece_);
  const std::uint64_t others = (outputs_before_ & ~effect.changed) | effect.on;
  return (others & ~timed_outputs_.mask()) | (timed & timed_outputs_.mask());
}

/// The way back is a motion of its own, that begins at rest where this one has come to rest.
void Interpolator::turn_where_wanted() noexcept VIAPOINT_NONBLOCKING {
  if (!wants_motion() || now_.rate != 0.0 || governor_.changing()) return;
  const auto wanted = wish_ == Wish::kBackward ? Direction::kBackward : Direction::kForward;
  if (wanted == direction_) return;
  const double tau = snapped(nominal(now_.tau));
  direction_ = wanted;
  rest_at(nominal(tau));
  piece_ = motion_->piece_at(nominal(now_.tau));  // there and back again may end a rounding away
  lookahead_.begin(*motion_, direction_);
}

void Interpolator::rest_at(double way) noexcept VIAPOINT_NONBLOCKING {
  now_ = {way, 0.0, 0.0};
  anchor_ = way;
  since_anchor_ = 0;
  governor_.reset();
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

bool Interpolator::ends_here() const noexcept {
  return direction_ == Direction::kForward && now_.tau >= motion_->duration();
}

RunState Interpolator::classify() const noexcept {
  if (ends_here()) return open_ ? classify_wait() : RunState::kFinished;
  const bool at_rest = now_.rate == 0.0 && !governor_.changing();
  if (is_stop()) return at_rest ? RunState::kStopped : RunState::kStopping;
  if (wants_motion()) return RunState::kRunning;
  return at_rest ? RunState::kPaused : RunState::kPausing;
}

void Interpolator::evaluate(double curvature, Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  const TrajectoryPiece& piece = motion_->pieces()[piece_];
  const double sign = direction_ == Direction::kForward ? 1.0 : -1.0;
  shown_ = {nominal(now_.tau), sign * now_.rate, sign * now_.slope};
  const JointState path = piece.at(motion_->time_in(piece_, shown_.tau));
  const double rate = shown_.rate, slope = shown_.slope;
  setpoint.q = path.q;
  setpoint.qd = path.qd * rate;
  setpoint.qdd = path.qdd * (rate * rate) + path.qd * slope;
  setpoint.qddd = path.qddd * (rate * rate * rate) + path.qdd * (3.0 * rate * slope) +
                  path.qd * (sign * curvature);
  setpoint.outputs = outputs_;
  position_ = path.q;
  move_ = piece.move;
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
  if (now_.tau > motion_->duration() - kEndSlack) {
    now_.tau = motion_->duration();
    if (direction_ == Direction::kBackward) rest_at(now_.tau);
  } else if (now_.tau > rest_place_ - kEndSlack) {
    rest_at(direction_ == Direction::kForward ? snapped(rest_place_) : rest_place_);
    if (direction_ == Direction::kForward) fresh_ = now_.tau;
  }
  stop_at_gate();
  const std::size_t piece = motion_->piece_at(nominal(now_.tau));
  if (step_move_ != kNoMove && motion_->pieces()[piece].move != step_move_) {
    end_step(piece);
  } else {
    enter_piece(piece);
  }
}

/// The step's move has ended before `piece`, or at its start.
void Interpolator::end_step(std::size_t piece) noexcept VIAPOINT_NONBLOCKING {
  std::size_t first = piece;
  for (int i = 0; i < kPiecesACycle && first > piece_; ++i, --first) {
    if (motion_->pieces()[first - 1].move == step_move_) break;
  }
  wish_ = Wish::kPause;
  step_move_ = kNoMove;
  if (rests_at_start_of(first)) {
    rest_at(motion_->start_of(first));
    piece = first;
  }
  enter_piece(piece);
}

bool Interpolator::rests_at_start_of(std::size_t piece) const noexcept VIAPOINT_NONBLOCKING {
  const JointState path = motion_->pieces()[piece].at(0.0);
  for (int i = 0; i < limits_.joints(); ++i) {
    if (std::abs(path.qd[i]) > kRestShare * limits_.velocity[i]) return false;
    if (std::abs(path.qdd[i]) > kRestShare * limits_.acceleration[i]) return false;
  }
  return true;
}

void Interpolator::enter_piece(std::size_t piece) noexcept VIAPOINT_NONBLOCKING {
  piece_ = piece;
  farthest_piece_ = std::max(farthest_piece_, piece);
  farthest_ = std::max(farthest_, nominal(now_.tau));
}

}  // namespace viapoint
