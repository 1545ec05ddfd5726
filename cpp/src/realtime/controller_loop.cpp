#include "viapoint/realtime/controller_loop.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "realtime/cycle_runner.hpp"
#include "realtime/loop_job.hpp"
#include "realtime/realtime_rights.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"
#include "viapoint/realtime/virtual_jog.hpp"

namespace viapoint {
namespace {

/// How often the companion looks for news.
constexpr std::chrono::milliseconds kCompanionPeriod{2};
constexpr std::chrono::microseconds kVirtualCompanionPeriod{100};

/// Enabled on construction, released on destruction, also when the loop cannot be built.
class PoweredDrive {
 public:
  explicit PoweredDrive(std::unique_ptr<Drive> drive)
      : drive_(std::move(drive)), start_(drive_->enable()) {}
  ~PoweredDrive() { release(); }
  /// Takes the power off, once.
  void release() {
    if (!std::exchange(released_, true)) drive_->release();
  }
  PoweredDrive(const PoweredDrive&) = delete;
  PoweredDrive& operator=(const PoweredDrive&) = delete;

  [[nodiscard]] Drive& drive() { return *drive_; }
  [[nodiscard]] const Measurement& start() const { return start_; }

 private:
  std::unique_ptr<Drive> drive_;
  Measurement start_;
  bool released_ = false;
};

std::unique_ptr<Drive> checked(std::unique_ptr<Drive> drive, const JointLimits& limits,
                               const LoopOptions& options) {
  limits.validate();
  if (drive == nullptr) throw MotionError(ErrorCode::kBadArgument, "there is no drive to run");
  if (drive->joints() != limits.joints()) {
    throw MotionError(ErrorCode::kBadArgument, "the drive has " + std::to_string(drive->joints()) +
                                                   " joints, the limits are for " +
                                                   std::to_string(limits.joints()));
  }
  if (options.cycle.count() <= 0) {
    throw MotionError(
        ErrorCode::kBadArgument,
        "the cycle is " + std::to_string(options.cycle.count()) + " ns; it must be positive");
  }
  if (options.log_records == 0) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the log is to keep 0 records; at least 1 is needed");
  }
  return drive;
}

}  // namespace

struct ControllerLoop::Impl {
  Impl(std::unique_ptr<Drive> drive, const JointLimits& joint_limits, const LoopOptions& options,
       std::unique_ptr<Clock> loop_clock)
      : limits(joint_limits),
        log_records(options.log_records),
        powered(checked(std::move(drive), joint_limits, options)),
        clock(std::move(loop_clock)),
        channels(limits.joints()),
        runner(powered.drive(), *clock, channels, limits, options, powered.start()) {
    if (powered.start().q.size() != limits.joints() || !powered.start().q.allFinite()) {
      throw MotionError(ErrorCode::kDriveFault,
                        "the drive does not tell where each joint stands after it was enabled");
    }
    channels.snapshot.write(powered.start().q, powered.start());
    if (options.lock_memory && !clock->is_virtual()) memory = lock_memory(shortcomings);
    start_threads();
    if (!clock->is_virtual()) raise_priority(loop, options.priority, shortcomings);
  }

  ~Impl() {
    bring_to_rest();
    channels.quit.store(true, std::memory_order_release);
    loop.join();
    companion.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Both or none. @throws MotionError(kDriveFault)
  void start_threads() try {
    companion = std::thread([this] { accompany(); });
    loop = std::thread([this] {
      prepare_loop_thread();
      runner.run();
    });
  } catch (const std::system_error& error) {
    channels.quit.store(true, std::memory_order_release);
    if (companion.joinable()) companion.join();
    throw MotionError(ErrorCode::kDriveFault,
                      std::string("a thread of the loop cannot be created: ") + error.what(),
                      {"end other programs, or allow more threads (\"ulimit -u\", or the "
                       "container's limit of processes) or more memory"});
  }

  void bring_to_rest() {
    const std::lock_guard lock(admission);
    if (jogs()) channels.jog.write(JointVector::Zero(limits.joints()));
    while (jogs()) std::this_thread::sleep_for(kCompanionPeriod);
    if (job == nullptr) return;
    job->stop(StopCategory::kHold);
    while (!job->ended()) std::this_thread::sleep_for(kCompanionPeriod);
  }

  /// A jog that is under way, or wished and not begun. A drive that failed or was released jogs no
  /// more.
  [[nodiscard]] bool jogs() const {
    if (channels.faulted.load(std::memory_order_acquire) ||
        channels.released.load(std::memory_order_acquire)) {
      return false;
    }
    return channels.jog.pending() || channels.jogging.load(std::memory_order_acquire);
  }

  void require_no_fault() {
    if (channels.released.load(std::memory_order_acquire)) {
      throw MotionError(ErrorCode::kDriveFault, "the drive was released by a stop of category 1",
                        {"connect again"});
    }
    if (!channels.faulted.load(std::memory_order_acquire)) return;
    throw MotionError(ErrorCode::kDriveFault, fault(),
                      {"clear the fault at the drive, then connect again"});
  }

  /// What has failed; empty while nothing has.
  [[nodiscard]] std::string fault() {
    if (!channels.faulted.load(std::memory_order_acquire)) return {};
    const Breach& breach = channels.breach;
    if (breach.kind == Breach::Kind::kDrive) return powered.drive().fault();
    std::ostringstream text;
    text << text_of(breach);
    if (breach.kind == Breach::Kind::kPowerLost) {
      text << ": " << powered.drive().fault() << "; the arm was measured last at";
    } else {
      text << "; the arm stopped " << (breach.path_is_held() ? "on" : "off") << " its path at";
    }
    for (const double q : channels.snapshot.read().measurement.q) text << ' ' << number_text(q);
    return text.str();
  }

  [[nodiscard]] bool busy() const { return job != nullptr && !job->ended(); }

  /// A run that shows its end is over, though its last records may still be on their way.
  void await_log_of_ended_run() const {
    const auto over = [](RunState state) {
      return state == RunState::kFinished || state == RunState::kStopped ||
             state == RunState::kFault;
    };
    while (busy() && over(job->state())) std::this_thread::sleep_for(kCompanionPeriod);
  }

  /// Carries the log out of the real-time part, and takes back what is spent.
  void accompany() {
    block_signals();
    while (!channels.quit.load(std::memory_order_acquire)) {
      // Before the log: what came back has all its records in the ring.
      const QueuedMotion* spent = channels.motions.take_back();
      drain_log();
      if (spent != nullptr) {
        const bool fault = spent->state.load(std::memory_order_acquire) == RunState::kFault;
        if (channels.released.load(std::memory_order_acquire)) powered.release();
        present_job()->end(fault ? fault_of_run() : std::string());
      }
      if (clock->is_virtual()) {
        std::this_thread::sleep_for(kVirtualCompanionPeriod);
      } else {
        std::this_thread::sleep_for(kCompanionPeriod);
      }
    }
  }

  /// Of a run that came back as failed: after a release nothing has, it was only refused.
  [[nodiscard]] std::string fault_of_run() {
    return channels.faulted.load(std::memory_order_acquire) ? fault() : "the drive was released";
  }

  void drain_log() {
    std::array<LogRecord, 64> batch;
    while (const std::size_t count = channels.log.pop(batch.data(), batch.size())) {
      present_job()->append({batch.data(), count});
    }
  }

  [[nodiscard]] std::shared_ptr<LoopJob> present_job() const {
    const std::lock_guard lock(job_mutex);
    return job;
  }

  JointLimits limits;
  std::size_t log_records;
  PoweredDrive powered;
  std::unique_ptr<Clock> clock;
  LoopChannels channels;
  CycleRunner runner;
  MemoryLock memory;
  std::vector<std::string> shortcomings;

  mutable std::mutex admission;  ///< one thread at a time feeds the queue
  mutable std::mutex job_mutex;  ///< guards the pointer `job`
  std::shared_ptr<LoopJob> job;  ///< the last run; written under both locks

  std::thread companion, loop;
};

ControllerLoop::ControllerLoop(std::unique_ptr<Drive> drive, const JointLimits& limits,
                               const LoopOptions& options, std::unique_ptr<Clock> clock)
    : impl_(std::make_unique<Impl>(std::move(drive), limits, options, std::move(clock))) {}

ControllerLoop::~ControllerLoop() = default;

std::shared_ptr<Job> ControllerLoop::run(std::shared_ptr<const Trajectory> trajectory,
                                         const std::function<void()>& last_word) {
  const std::lock_guard lock(impl_->admission);
  if (trajectory == nullptr) throw MotionError(ErrorCode::kBadArgument, "there is no motion");
  impl_->require_no_fault();
  impl_->await_log_of_ended_run();
  if (impl_->busy()) {
    throw MotionError(ErrorCode::kBusy, "a run is already under way",
                      {"wait for its end", "stop it first"});
  }
  if (impl_->jogs()) {
    throw MotionError(ErrorCode::kBusy, "the arm is being jogged",
                      {"stop the jog, and wait until the arm rests"});
  }
  admit(*trajectory, impl_->limits, position());
  auto job = std::make_shared<LoopJob>(std::move(trajectory), impl_->log_records);
  if (last_word) last_word();
  {
    const std::lock_guard job_lock(impl_->job_mutex);
    impl_->job = job;
  }
  if (!impl_->channels.motions.push(job->motion())) {
    throw MotionError(ErrorCode::kInternal, "the queue of motions is full although none runs");
  }
  return job;
}

void ControllerLoop::jog(const JointVector& velocity) {
  admit_jog(velocity, impl_->limits);
  const std::lock_guard lock(impl_->admission);
  impl_->require_no_fault();
  impl_->await_log_of_ended_run();
  if (impl_->busy() && !impl_->job->may_be_jogged()) {
    throw MotionError(ErrorCode::kBusy,
                      "a run is under way, and the arm jogs only between runs and in a pause",
                      {"wait for its end", "pause it and wait until it rests", "stop it first"});
  }
  impl_->channels.jog.write(velocity);
}

bool ControllerLoop::jogging() const { return impl_->jogs(); }

std::string ControllerLoop::jog_block() const {
  return text_of(impl_->channels.jog_block.load(std::memory_order_relaxed));
}

void ControllerLoop::keep_alive(std::chrono::nanoseconds lease) {
  const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(lease).count();
  const auto least = std::int64_t{0};
  const auto most = std::int64_t{std::numeric_limits<std::uint32_t>::max()};
  const auto microseconds = static_cast<std::uint32_t>(std::clamp(whole, least, most));
  Lease present = impl_->channels.lease;
  while (
      !impl_->channels.lease.compare_exchange_weak(present, {present.number + 1, microseconds})) {
  }
}

void ControllerLoop::set_override(double share) {
  if (!(share >= 0.0 && share <= 1.0)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the override is " + number_text(share) + "; it must lie in [0, 1]",
                      {"give a share of the programmed speed, e.g. 0.5"});
  }
  impl_->channels.override_share.store(share, std::memory_order_relaxed);
}

double ControllerLoop::override_share() const {
  return impl_->channels.override_share.load(std::memory_order_relaxed);
}

Measurement ControllerLoop::measured() const { return impl_->channels.snapshot.read().measurement; }

bool ControllerLoop::busy() const {
  const auto job = impl_->present_job();
  return job != nullptr && !job->ended();
}

JointVector ControllerLoop::position() const { return impl_->channels.snapshot.read().position; }

std::string ControllerLoop::fault() const { return impl_->fault(); }

std::vector<LogRecord> ControllerLoop::fault_cycles() const {
  if (!impl_->channels.faulted.load(std::memory_order_acquire)) return {};
  return impl_->channels.history.records();
}

std::vector<std::string> ControllerLoop::shortcomings() const { return impl_->shortcomings; }

}  // namespace viapoint
