#include "viapoint/realtime/controller_loop.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "realtime/realtime_rights.hpp"
#include "realtime/run_desk.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

/// How often the companion looks for news.
constexpr std::chrono::milliseconds kCompanionPeriod{2};
constexpr std::chrono::microseconds kVirtualCompanionPeriod{100};

}  // namespace

struct ControllerLoop::Impl {
  Impl(std::unique_ptr<Drive> drive, const JointLimits& limits, const LoopOptions& options,
       std::unique_ptr<Clock> clock)
      : desk(std::move(drive), limits, options, std::move(clock)) {
    const bool is_virtual = desk.clock().is_virtual();
    if (options.lock_memory && !is_virtual) memory = lock_memory(shortcomings);
    start_threads();
    if (is_virtual) return;
    raise_priority(loop, options.priority, shortcomings);
    if (options.processor) keep_on(loop, *options.processor, shortcomings);
    if (options.keep_awake) awake = keep_processors_awake(shortcomings);
  }

  ~Impl() {
    bring_to_rest();
    desk.channels().quit.store(true, std::memory_order_release);
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
      desk.runner().run();
    });
  } catch (const std::system_error& error) {
    desk.channels().quit.store(true, std::memory_order_release);
    if (companion.joinable()) companion.join();
    throw MotionError(ErrorCode::kDriveFault,
                      std::string("a thread of the loop cannot be created: ") + error.what(),
                      {"end other programs, or allow more threads (\"ulimit -u\", or the "
                       "container's limit of processes) or more memory"});
  }

  void bring_to_rest() {
    const std::lock_guard lock(desk.admission());
    if (desk.jogs()) desk.channels().jog.write(JointVector::Zero(desk.limits().joints()));
    while (desk.jogs()) std::this_thread::sleep_for(kCompanionPeriod);
    const auto job = desk.job();
    if (job == nullptr) return;
    job->stop(StopCategory::kHold);
    while (!job->ended()) std::this_thread::sleep_for(kCompanionPeriod);
  }

  void accompany() {
    block_signals();
    while (!desk.channels().quit.load(std::memory_order_acquire)) {
      desk.see_to();
      if (desk.clock().is_virtual()) {
        std::this_thread::sleep_for(kVirtualCompanionPeriod);
      } else {
        std::this_thread::sleep_for(kCompanionPeriod);
      }
    }
  }

  RunDesk desk;
  MemoryLock memory;
  WakefulProcessors awake;
  std::vector<std::string> shortcomings;
  std::thread companion, loop;
};

ControllerLoop::ControllerLoop(std::unique_ptr<Drive> drive, const JointLimits& limits,
                               const LoopOptions& options, std::unique_ptr<Clock> clock)
    : impl_(std::make_unique<Impl>(std::move(drive), limits, options, std::move(clock))) {}

ControllerLoop::~ControllerLoop() = default;

std::shared_ptr<Job> ControllerLoop::run(std::shared_ptr<const Trajectory> trajectory,
                                         const std::function<void()>& last_word) {
  return impl_->desk.run(std::move(trajectory), false, last_word);
}

std::shared_ptr<OpenJob> ControllerLoop::follow(std::shared_ptr<const Trajectory> first,
                                                const std::function<void()>& last_word) {
  return impl_->desk.run(std::move(first), true, last_word);
}

void ControllerLoop::jog(const JointVector& velocity) { impl_->desk.jog(velocity); }

void ControllerLoop::admit_hand(const std::function<void(const Measurement&)>& take) {
  impl_->desk.admit_hand(take);
}

bool ControllerLoop::jogging() const { return impl_->desk.jogs(); }

std::string ControllerLoop::jog_block() const {
  return text_of(impl_->desk.channels().jog_block.load(std::memory_order_relaxed));
}

void ControllerLoop::keep_alive(std::chrono::nanoseconds lease) {
  const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(lease).count();
  const auto least = std::int64_t{0};
  const auto most = std::int64_t{std::numeric_limits<std::uint32_t>::max()};
  const auto microseconds = static_cast<std::uint32_t>(std::clamp(whole, least, most));
  std::atomic<Lease>& newest = impl_->desk.channels().lease;
  Lease present = newest;
  while (!newest.compare_exchange_weak(present, {present.number + 1, microseconds})) {
  }
}

void ControllerLoop::set_override(double share) { impl_->desk.set_override(share); }

double ControllerLoop::override_share() const {
  return impl_->desk.channels().override_share.load(std::memory_order_relaxed);
}

Measurement ControllerLoop::measured() const {
  return impl_->desk.channels().snapshot.read().measurement;
}

LoopCycle ControllerLoop::newest_cycle() const { return impl_->desk.channels().snapshot.read(); }

std::vector<ObservedCycle> ControllerLoop::observed(std::uint64_t from, std::size_t most) const {
  return impl_->desk.channels().tape.read(from, most);
}

void ControllerLoop::switch_outputs(std::uint64_t mask, std::uint64_t values) {
  impl_->desk.channels().switches.set(mask, values);
}

bool ControllerLoop::guided() const { return impl_->desk.is_guided(); }

bool ControllerLoop::busy() const {
  const auto job = impl_->desk.job();
  return job != nullptr && !job->ended();
}

JointVector ControllerLoop::position() const { return impl_->desk.channels().snapshot.read().q; }

std::string ControllerLoop::fault() const { return impl_->desk.fault(); }

void ControllerLoop::require_power() const { impl_->desk.require_power(); }

std::vector<LogRecord> ControllerLoop::fault_cycles() const { return impl_->desk.fault_cycles(); }

std::vector<std::string> ControllerLoop::shortcomings() const { return impl_->shortcomings; }

}  // namespace viapoint
