#include "realtime/cycle_runner.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <thread>
#include <utility>

namespace viapoint {

CycleRunner::CycleRunner(Drive& drive, Clock& clock, LoopChannels& channels,
                         const JointLimits& limits, const LoopOptions& options,
                         const Measurement& start)
    : drive_(drive),
      clock_(clock),
      channels_(channels),
      interpolator_(limits, options.cycle, start.q),
      guard_(limits, options.cycle, options.guard, start.q),
      cycle_(options.cycle.count()),
      wished_(start.q),
      measurement_(start) {
  setpoint_.q = start.q;
}

void CycleRunner::run() noexcept {
  due_ = clock_.now();
  while (!channels_.quit.load(std::memory_order_acquire)) {
    cycle();
    if (clock_.is_virtual()) let_others_run();
  }
}

void CycleRunner::cycle() noexcept {
  wait_for_cycle();
  do_cycle();
}

void CycleRunner::wait_for_cycle() noexcept {
  // Cycles slept through are gone: the grid goes on from the wake-up.
  due_ += (1 + late_cycles_) * cycle_;
  clock_.sleep_until(due_);
  woke_ = clock_.now();
  // A clock that goes back, which CLOCK_MONOTONIC never does, must not leave the drive without.
  due_ = std::min(due_, woke_);
  late_cycles_ = (woke_ - due_) / cycle_;
}

void CycleRunner::do_cycle() noexcept VIAPOINT_NONBLOCKING {
  if (channels_.faulted.load(std::memory_order_relaxed) ||
      channels_.released.load(std::memory_order_relaxed)) {
    refuse_next();
    return;
  }
  // After a breach nothing new begins: what moves is brought to rest.
  const bool is_sound = !guard_.breach().any();
  if (motion_ == nullptr && !interpolator_.jogging() && is_sound) begin_next();
  // Read first and acted on last: a jog comes with the pause that was wished before it.
  const bool is_jog = channels_.jog.read(wished_);
  if (motion_ != nullptr) {
    // The safest of one cycle last: who pauses is not overruled by an input that resumes.
    take_input(motion_->reactions.front());
    take_wish();
    for (auto& place : std::span(motion_->reactions).subspan<1>()) take_input(place);
  }
  if (motion_ != nullptr && motion_->open) take_link();
  if (is_jog) jog();
  hold_lease();
  interpolator_.set_override(channels_.override_share.load(std::memory_order_relaxed));

  interpolator_.set_inputs(measurement_.inputs);

  const std::int64_t begin = clock_.now();
  if (!off_path_) {
    interpolator_.tick(setpoint_);
    outputs_.follow(setpoint_.outputs);
  }
  outputs_.switch_by_hand(channels_.switches);
  setpoint_.outputs = outputs_.sent();
  const bool is_at_rest = guard();
  const std::int64_t end = clock_.now();
  const DriveStatus status = drive_.exchange(setpoint_, measurement_);
  guard_.look_at(status, measurement_, late_cycles_);
  if (status == DriveStatus::kGuided) follow_hand();
  const bool is_dead = status == DriveStatus::kFault || status == DriveStatus::kPowerLost;
  fails_ = is_dead || is_at_rest;
  if (fails_) interpolator_.abandon();
  channels_.jogging.store(interpolator_.jogging() || stops_off_path(), std::memory_order_release);
  channels_.jog_block.store(interpolator_.jog_block(), std::memory_order_relaxed);
  show();
  // Last: who sees the hand off the arm sees the setpoint where it has left it.
  channels_.guided.store(status == DriveStatus::kGuided, std::memory_order_release);
  record(end - begin);
  if (motion_ != nullptr && stops_off_path()) {
    motion_->state.store(RunState::kStopping, std::memory_order_release);
  }
  if (fails_) {
    fail(status);
  } else if (motion_ != nullptr && !off_path_) {
    finish();
  }
}

bool CycleRunner::guard() noexcept VIAPOINT_NONBLOCKING {
  const Guard::Verdict verdict = guard_.pass(setpoint_);
  if (verdict == Guard::Verdict::kPass) return false;
  // A fault comes one cycle after rest, so that the drive has measured it.
  if (verdict != Guard::Verdict::kStopOnPath) {
    off_path_ = true;
    interpolator_.abandon();
    return verdict == Guard::Verdict::kAtRest && std::exchange(is_resting_, true);
  }
  if (interpolator_.active()) interpolator_.wish(Wish::kStop);
  if (interpolator_.jogging()) interpolator_.stop_jog();
  if (interpolator_.active() || interpolator_.jogging()) return false;
  return std::exchange(is_resting_, true);
}

void CycleRunner::fail(DriveStatus status) noexcept VIAPOINT_NONBLOCKING {
  channels_.breach = guard_.breach();
  channels_.last_status = status;
  channels_.faulted.store(true, std::memory_order_release);
  if (motion_ == nullptr) return;
  motion_->state.store(RunState::kFault, std::memory_order_release);
  channels_.motions.give_back(motion_);
  motion_ = nullptr;
}

void CycleRunner::follow_hand() noexcept VIAPOINT_NONBLOCKING {
  if (motion_ != nullptr || interpolator_.jogging() || off_path_) return guard_.refuse_hand();
  if (guard_.breach().any()) return;
  interpolator_.stand_at(measurement_.q);
  guard_.stand_at(measurement_.q);
}

void CycleRunner::jog() noexcept VIAPOINT_NONBLOCKING {
  if (!guard_.breach().any()) interpolator_.jog(wished_);
  // In this order: who sees the wish done sees the jog that it began.
  channels_.jogging.store(interpolator_.jogging(), std::memory_order_release);
  channels_.jog.done();
}

void CycleRunner::hold_lease() noexcept VIAPOINT_NONBLOCKING {
  const Lease lease = channels_.lease.load(std::memory_order_acquire);
  if (lease.number != lease_) {
    lease_ = lease.number;
    alive_until_ = woke_ + std::int64_t{lease.microseconds} * 1000;
  }
  if (woke_ < alive_until_) return;
  if (interpolator_.active()) interpolator_.wish(Wish::kPause);
  if (interpolator_.jogging()) interpolator_.stop_jog();
}

void CycleRunner::take_input(std::atomic<InputReaction>& place) noexcept VIAPOINT_NONBLOCKING {
  InputReaction reaction = place.load(std::memory_order_acquire);
  if (!reaction.is_met_by(measurement_.inputs)) return;
  interpolator_.wish(reaction.wish);
  // One that has been put in its place meanwhile stays.
  place.compare_exchange_strong(reaction, InputReaction{});
}

void CycleRunner::take_wish() noexcept VIAPOINT_NONBLOCKING {
  const NumberedWish wish = motion_->wish.load(std::memory_order_acquire);
  if (wish.number == wish_.number) return;
  wish_ = wish;
  interpolator_.wish(wish.wish);
}

void CycleRunner::take_link() noexcept VIAPOINT_NONBLOCKING {
  const MotionLink* link = motion_->link.load(std::memory_order_acquire);
  if (link != nullptr && interpolator_.active()) {
    const LinkFate fate = interpolator_.lengthen(*link);
    if (fate == LinkFate::kNotYet) return;
    motion_->fate.store(fate, std::memory_order_relaxed);
    motion_->link.store(nullptr, std::memory_order_release);
  } else if (motion_->closed.load(std::memory_order_acquire)) {
    interpolator_.close();
  }
}

void CycleRunner::begin_next() noexcept VIAPOINT_NONBLOCKING {
  motion_ = channels_.motions.pop();
  if (motion_ == nullptr) return;
  interpolator_.set_override(channels_.override_share.load(std::memory_order_relaxed));
  // What was switched by hand before the motion was told is no change that comes after its own.
  outputs_.switch_by_hand(channels_.switches);
  interpolator_.set_outputs(outputs_.sent());
  outputs_.hand_over();
  interpolator_.begin(*motion_->trajectory, motion_->open);
  wish_ = {};
  cycle_of_run_ = 0;
  arriving_ = false;
}

void CycleRunner::refuse_next() noexcept VIAPOINT_NONBLOCKING {
  QueuedMotion* motion = channels_.motions.pop();
  if (motion == nullptr) return;
  motion->state.store(RunState::kFault, std::memory_order_release);
  channels_.motions.give_back(motion);
}

void CycleRunner::show() noexcept VIAPOINT_NONBLOCKING {
  ++shown_.cycle;
  shown_.stamp = woke_;
  shown_.state = stops_off_path() ? RunState::kStopping : interpolator_.state();
  shown_.rate = interpolator_.rate();
  shown_.override_share = channels_.override_share.load(std::memory_order_relaxed);
  shown_.q = setpoint_.q;
  shown_.qd = setpoint_.qd;
  shown_.qdd = setpoint_.qdd;
  shown_.outputs = setpoint_.outputs;
  shown_.measurement = measurement_;
  channels_.snapshot.write(shown_);
  channels_.tape.write(shown_);
}

void CycleRunner::record(std::int64_t compute) noexcept VIAPOINT_NONBLOCKING {
  interpolator_.describe(setpoint_, record_);
  if (stops_off_path()) record_.state = RunState::kStopping;
  record_.cycle = motion_ != nullptr ? cycle_of_run_ : setpoint_.cycle;
  record_.stamp = woke_;
  record_.latency = woke_ - due_;
  record_.compute = compute;
  record_.measured = measurement_.q;
  channels_.history.append(record_);
  // The cycle after the last setpoint only measures.
  if (motion_ == nullptr || (arriving_ && record_.state != RunState::kFault)) return;
  ++cycle_of_run_;
  QueuedMotion& motion = *motion_;
  if (!channels_.log.push(record_)) motion.lost_records.fetch_add(1, std::memory_order_relaxed);
  if (late_cycles_ > 0) {
    motion.overruns.fetch_add(1, std::memory_order_relaxed);
    motion.missed_cycles.fetch_add(static_cast<std::uint64_t>(late_cycles_),
                                   std::memory_order_relaxed);
  }
  motion.nominal_time.store(record_.nominal_time, std::memory_order_relaxed);
  if (motion.open) {
    motion.settled_time.store(interpolator_.settled_time(), std::memory_order_relaxed);
    if (record_.state == RunState::kWaiting && !interpolator_.awaits_input()) {
      motion.waited_cycles.fetch_add(1, std::memory_order_relaxed);
    }
  }
  motion.move.store(record_.move, std::memory_order_relaxed);
  AwaitedInput awaited;
  if (interpolator_.awaits_input()) awaited = AwaitedInput::of(interpolator_.awaited());
  motion.awaited.store(awaited, std::memory_order_relaxed);
}

void CycleRunner::finish() noexcept VIAPOINT_NONBLOCKING {
  const RunState state = interpolator_.state();
  const bool rests = state == RunState::kFinished || state == RunState::kStopped;
  if (rests && !arriving_) {
    arriving_ = true;
    return;
  }
  motion_->may_be_jogged.store(interpolator_.may_be_jogged(), std::memory_order_relaxed);
  motion_->acted_on.store(wish_.number, std::memory_order_release);
  if (interpolator_.input_missed()) {
    motion_->missed.store(AwaitedInput::of(interpolator_.awaited()), std::memory_order_relaxed);
  }
  motion_->state.store(state, std::memory_order_release);
  if (!rests) return;
  // Before the motion goes back: who sees the stop's end sees that the drive is to be released.
  // A stop wished while the arm came to rest at its end anyway releases the drive, too.
  if (wish_.wish == Wish::kRelease) {
    channels_.released.store(true, std::memory_order_release);
  }
  channels_.motions.give_back(motion_);
  motion_ = nullptr;
}

void CycleRunner::let_others_run() noexcept {
  // Virtual time passes slowly without a motion, and waits for the reader of the log.
  constexpr std::chrono::microseconds kPause{200};
  if (motion_ == nullptr) std::this_thread::sleep_for(kPause);
  while (channels_.log.write_available() == 0) std::this_thread::sleep_for(kPause);
}

}  // namespace viapoint
