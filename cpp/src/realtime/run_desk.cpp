#include "realtime/run_desk.hpp"

#include <array>
#include <chrono>
#include <sstream>
#include <thread>
#include <utility>

#include "realtime/require_cycle.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"

namespace viapoint {
namespace {

/// How often the end of a log is looked for.
constexpr std::chrono::milliseconds kLook{2};

std::unique_ptr<Drive> checked(std::unique_ptr<Drive> drive, const JointLimits& limits,
                               const LoopOptions& options) {
  limits.validate();
  if (drive == nullptr) throw MotionError(ErrorCode::kBadArgument, "there is no drive to run");
  if (drive->joints() != limits.joints()) {
    throw MotionError(ErrorCode::kBadArgument, "the drive has " + std::to_string(drive->joints()) +
                                                   " joints, the limits are for " +
                                                   std::to_string(limits.joints()));
  }
  require_cycle(options.cycle);
  if (options.log_records == 0) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the log is to keep 0 records; at least 1 is needed");
  }
  return drive;
}

}  // namespace

RunDesk::RunDesk(std::unique_ptr<Drive> drive, const JointLimits& limits,
                 const LoopOptions& options, std::unique_ptr<Clock> clock)
    : limits_(limits),
      log_records_(options.log_records),
      powered_(checked(std::move(drive), limits, options)),
      clock_(std::move(clock)),
      channels_(limits.joints()),
      runner_(powered_.drive(), *clock_, channels_, limits_, options, powered_.start()) {
  if (powered_.start().q.size() != limits.joints() || !powered_.start().q.allFinite()) {
    throw MotionError(ErrorCode::kDriveFault,
                      "the drive does not tell where each joint stands after it was enabled");
  }
  LoopCycle start;
  start.q = powered_.start().q;
  start.measurement = powered_.start();
  start.stamp = clock_->now();
  channels_.snapshot.write(start);
}

std::shared_ptr<LoopJob> RunDesk::run(std::shared_ptr<const Trajectory> trajectory, bool open,
                                      const std::function<void()>& last_word) {
  const std::lock_guard lock(admission_);
  if (trajectory == nullptr) throw MotionError(ErrorCode::kBadArgument, "there is no motion");
  require_rest();
  require_no_hand();
  admit(*trajectory, limits_, channels_.snapshot.read().q);
  auto job = std::make_shared<LoopJob>(std::move(trajectory), limits_, log_records_, open);
  if (last_word) last_word();
  {
    const std::lock_guard job_lock(job_mutex_);
    job_ = job;
  }
  if (!channels_.motions.push(job->motion())) {
    throw MotionError(ErrorCode::kInternal, "the queue of motions is full although none runs");
  }
  return job;
}

void RunDesk::jog(const JointVector& velocity) {
  admit_jog(velocity, limits_);
  const std::lock_guard lock(admission_);
  await_log_of_ended_run();
  require_power();
  if (busy() && !job_->may_be_jogged()) {
    throw MotionError(ErrorCode::kBusy,
                      "a run is under way, and the arm jogs only between runs and in a pause",
                      {"wait for its end", "pause it and wait until it rests", "stop it first"});
  }
  require_no_hand();
  channels_.jog.write(velocity);
}

void RunDesk::admit_hand(const std::function<void(const Measurement&)>& take) {
  const std::lock_guard lock(admission_);
  require_rest();
  take(channels_.snapshot.read().measurement);
}

bool RunDesk::is_guided() const {
  if (channels_.faulted.load(std::memory_order_acquire)) return false;
  // In this order: a hand that is found to have let go was seen by the loop, which still says so
  // until its setpoint is where the hand has left the arm.
  return powered_.drive().is_held() || channels_.guided.load(std::memory_order_acquire);
}

bool RunDesk::jogs() const {
  if (channels_.faulted.load(std::memory_order_acquire) ||
      channels_.released.load(std::memory_order_acquire)) {
    return false;
  }
  return channels_.jog.pending() || channels_.jogging.load(std::memory_order_acquire);
}

void RunDesk::set_override(double share) {
  if (!(share >= 0.0 && share <= 1.0)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the override is " + number_text(share) + "; it must lie in [0, 1]",
                      {"give a share of the programmed speed, e.g. 0.5"});
  }
  channels_.override_share.store(share, std::memory_order_relaxed);
}

void RunDesk::require_rest() {
  await_log_of_ended_run();
  // After it: a stop that releases the drive has done so by then.
  require_power();
  if (busy()) {
    throw MotionError(ErrorCode::kBusy, "a run is already under way",
                      {"wait for its end", "stop it first"});
  }
  if (jogs()) {
    throw MotionError(ErrorCode::kBusy, "the arm is being jogged",
                      {"stop the jog, and wait until the arm rests"});
  }
}

void RunDesk::require_no_hand() const {
  if (!is_guided()) return;
  throw MotionError(ErrorCode::kBusy, "the arm is guided by hand",
                    {"let go of it, and wait until it is not guided any more"});
}

void RunDesk::require_power() {
  if (channels_.released.load(std::memory_order_acquire)) {
    throw MotionError(ErrorCode::kDriveFault, "the drive was released by a stop of category 1",
                      {"connect again"});
  }
  if (!channels_.faulted.load(std::memory_order_acquire)) return;
  throw MotionError(ErrorCode::kDriveFault, fault(),
                    {"clear the fault at the drive, then connect again"});
}

std::string RunDesk::fault() {
  if (!channels_.faulted.load(std::memory_order_acquire)) return {};
  const Breach& breach = channels_.breach;
  if (breach.kind == Breach::Kind::kDrive) return powered_.drive().fault();
  std::ostringstream text;
  text << text_of(breach);
  const DriveStatus status = channels_.last_status;
  if (status == DriveStatus::kFault || status == DriveStatus::kPowerLost) {
    // Either the breach itself, or what came before its stop was over.
    if (breach.kind != Breach::Kind::kPowerLost) {
      text << "; while the arm stopped, "
           << (status == DriveStatus::kFault ? "its drive failed" : "its power went");
    }
    text << ": " << powered_.drive().fault() << "; the arm was measured last at";
  } else {
    text << "; the arm stopped " << (breach.path_is_held() ? "on" : "off") << " its path at";
  }
  for (const double q : channels_.snapshot.read().measurement.q) text << ' ' << number_text(q);
  return text.str();
}

std::vector<LogRecord> RunDesk::fault_cycles() const {
  if (!channels_.faulted.load(std::memory_order_acquire)) return {};
  return channels_.history.records();
}

std::shared_ptr<LoopJob> RunDesk::job() const {
  const std::lock_guard lock(job_mutex_);
  return job_;
}

bool RunDesk::busy() const { return job_ != nullptr && !job_->ended(); }

/// A run that shows its end is over, though its last records may still be on their way.
void RunDesk::await_log_of_ended_run() const {
  const auto over = [](RunState state) {
    return state == RunState::kFinished || state == RunState::kStopped || state == RunState::kFault;
  };
  while (busy() && over(job_->state())) std::this_thread::sleep_for(kLook);
}

void RunDesk::see_to() {
  // Before the log: what came back has all its records in the ring.
  const QueuedMotion* spent = channels_.motions.take_back();
  drain_log();
  if (spent == nullptr) return;
  const bool fault = spent->state.load(std::memory_order_acquire) == RunState::kFault;
  if (channels_.released.load(std::memory_order_acquire)) powered_.release();
  job()->end(fault ? fault_of_run() : std::string());
}

/// Of a run that came back as failed: after a release nothing has, it was only refused.
std::string RunDesk::fault_of_run() {
  return channels_.faulted.load(std::memory_order_acquire) ? fault() : "the drive was released";
}

void RunDesk::drain_log() {
  std::array<LogRecord, 64> batch;
  while (const std::size_t count = channels_.log.pop(batch.data(), batch.size())) {
    job()->append({batch.data(), count});
  }
}

}  // namespace viapoint
