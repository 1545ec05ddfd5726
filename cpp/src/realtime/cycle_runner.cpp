#include "realtime/cycle_runner.hpp"

#include <chrono>
#include <thread>

namespace viapoint {

CycleRunner::CycleRunner(Drive& drive, Clock& clock, LoopChannels& channels,
                         const JointLimits& limits, std::chrono::nanoseconds cycle,
                         const Measurement& start)
    : drive_(drive),
      clock_(clock),
      channels_(channels),
      interpolator_(limits, cycle, start.q),
      cycle_(cycle.count()),
      wished_(start.q),
      measurement_(start) {
  setpoint_.q = start.q;
}

void CycleRunner::run() noexcept {
  due_ = clock_.now();
  while (!channels_.quit.load(std::memory_order_acquire)) {
    wait_for_cycle();
    do_cycle();
    if (clock_.is_virtual()) let_others_run();
  }
}

void CycleRunner::wait_for_cycle() noexcept {
  // Cycles slept through are gone: the grid goes on from the wake-up.
  due_ += (1 + late_cycles_) * cycle_;
  clock_.sleep_until(due_);
  woke_ = clock_.now();
  late_cycles_ = (woke_ - due_) / cycle_;
}

void CycleRunner::do_cycle() noexcept VIAPOINT_NONBLOCKING {
  if (channels_.faulted.load(std::memory_order_relaxed)) {
    refuse_next();
    return;
  }
  if (motion_ == nullptr && !interpolator_.jogging()) begin_next();
  if (motion_ == nullptr) jog();
  interpolator_.set_override(channels_.override_share.load(std::memory_order_relaxed));
  if (motion_ != nullptr) interpolator_.wish(motion_->wish.load(std::memory_order_acquire));

  const std::int64_t begin = clock_.now();
  interpolator_.tick(setpoint_);
  const std::int64_t end = clock_.now();
  const bool fault = drive_.exchange(setpoint_, measurement_) == DriveStatus::kFault;
  if (fault) interpolator_.abandon();
  channels_.jogging.store(interpolator_.jogging(), std::memory_order_release);
  channels_.jog_block.store(interpolator_.jog_block(), std::memory_order_relaxed);
  channels_.snapshot.write(setpoint_.q, measurement_);

  if (motion_ != nullptr) {
    if (!arriving_ || fault) record(end - begin);
    finish();
  }
  if (fault) channels_.faulted.store(true, std::memory_order_release);
}

void CycleRunner::jog() noexcept VIAPOINT_NONBLOCKING {
  if (!channels_.jog.read(wished_)) return;
  interpolator_.jog(wished_);
  // In this order: who sees the wish done sees the jog that it began.
  channels_.jogging.store(interpolator_.jogging(), std::memory_order_release);
  channels_.jog.done();
}

void CycleRunner::begin_next() noexcept VIAPOINT_NONBLOCKING {
  motion_ = channels_.motions.pop();
  if (motion_ == nullptr) return;
  interpolator_.set_override(channels_.override_share.load(std::memory_order_relaxed));
  interpolator_.begin(*motion_->trajectory);
  cycle_of_run_ = 0;
  arriving_ = false;
}

void CycleRunner::refuse_next() noexcept VIAPOINT_NONBLOCKING {
  QueuedMotion* motion = channels_.motions.pop();
  if (motion == nullptr) return;
  motion->state.store(RunState::kFault, std::memory_order_release);
  channels_.motions.give_back(motion);
}

void CycleRunner::record(std::int64_t compute) noexcept VIAPOINT_NONBLOCKING {
  QueuedMotion& motion = *motion_;
  interpolator_.describe(setpoint_, record_);
  record_.cycle = cycle_of_run_++;
  record_.stamp = woke_;
  record_.latency = woke_ - due_;
  record_.compute = compute;
  record_.measured = measurement_.q;
  if (!channels_.log.push(record_)) motion.lost_records.fetch_add(1, std::memory_order_relaxed);
  if (late_cycles_ > 0) {
    motion.overruns.fetch_add(1, std::memory_order_relaxed);
    motion.missed_cycles.fetch_add(static_cast<std::uint64_t>(late_cycles_),
                                   std::memory_order_relaxed);
  }
  motion.nominal_time.store(record_.nominal_time, std::memory_order_relaxed);
  motion.move.store(record_.move, std::memory_order_relaxed);
}

void CycleRunner::finish() noexcept VIAPOINT_NONBLOCKING {
  const RunState state = interpolator_.state();
  const bool rests = state == RunState::kFinished || state == RunState::kStopped;
  if (rests && !arriving_) {
    arriving_ = true;
    return;
  }
  motion_->state.store(state, std::memory_order_release);
  if (!rests && state != RunState::kFault) return;
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
