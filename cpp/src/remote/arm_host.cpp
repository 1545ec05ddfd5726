#include "viapoint/remote/arm_host.hpp"

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>
#include <utility>

#include "remote/loop_look.hpp"
#include "remote/motion_inbox.hpp"
#include "remote/open_run.hpp"
#include "remote/run_book.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/remote/control_seat.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {
namespace {

using std::chrono::steady_clock;

// An operator may be silent for these shares of the heartbeat, so that the stop has begun within
// it. The seat is lost first and sees to everything; the loop holds the arm by itself even if no
// thread of ordinary priority gets to run.
constexpr double kSeatShare = 0.9, kLoopShare = 0.95;
constexpr double kSlice = 0.05;  ///< of a wait for a run's end [s]
std::chrono::nanoseconds share_of(double share, std::chrono::nanoseconds heartbeat) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(share * heartbeat);
}

}  // namespace

struct ArmHost::Impl {
  Impl(const JointLimits& joint_limits, MakeLoop maker, std::chrono::nanoseconds heartbeat,
       OnRun on_run, OnLoss on_loss)
      : limits(joint_limits),
        make_loop(std::move(maker)),
        tell_run(std::move(on_run)),
        tell_loss(std::move(on_loss)),
        lease(share_of(kLoopShare, heartbeat)),
        loop(make_loop({})),
        seat(share_of(kSeatShare, heartbeat)),
        watchdog([this] { watch(); }) {}

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      quits = true;
    }
    changed.notify_all();
    watchdog.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Takes the arm from an operator who has fallen silent.
  void watch() {
    std::unique_lock lock(mutex);
    while (!quits) {
      if (seat.expire(steady_clock::now())) {
        abandon(lock);
      } else if (const auto deadline = seat.deadline()) {
        changed.wait_until(lock, *deadline);
      } else {
        changed.wait(lock);
      }
    }
  }

  /// Nobody commands the arm any more: it comes to rest on its path, and waits. @pre locked
  void abandon(std::unique_lock<std::mutex>& lock) {
    pending.clear();
    if (tell_loss) tell_loss();
    if (const KeptRun* const newest = runs.newest()) newest->job->pause();
    const std::shared_ptr<ControllerLoop> present = loop;
    const std::shared_ptr<OpenRun> open = runs.newest() ? runs.newest()->open : nullptr;
    if (present != nullptr) present->keep_alive(std::chrono::nanoseconds::zero());
    lock.unlock();
    if (present != nullptr) end_jog(*present);
    if (open != nullptr) open->close();
    lock.lock();
  }

  void end_jog(ControllerLoop& of) const {
    if (!of.jogging()) return;
    try {
      of.jog(JointVector::Zero(limits.joints()));
    } catch (const MotionError& error) {
      // A run that began, or a drive that failed, has ended the jog already.
      if (error.code() != ErrorCode::kBusy && error.code() != ErrorCode::kDriveFault) throw;
    }
  }

  /// @pre not locked
  [[nodiscard]] std::shared_ptr<OpenRun> open_run(const std::string& token,
                                                  std::uint64_t number) const {
    const std::lock_guard lock(mutex);
    seat.require(token);
    if (std::shared_ptr<OpenRun> open = runs.find(number).open) return open;
    throw MotionError(ErrorCode::kBadArgument,
                      "run " + std::to_string(number) + " is of a motion that was whole",
                      {"begin a stream"});
  }

  /// The motion collected, which nobody runs but the caller. @pre not locked
  [[nodiscard]] std::shared_ptr<const Trajectory> take_pending() {
    std::unique_lock lock(mutex);
    std::vector<TrajectoryPiece> pieces = pending.take();
    lock.unlock();
    return std::make_shared<const Trajectory>(std::move(pieces), limits);
  }

  /// Begins what is collected by `start`, given the loop, the motion, and what it has to call last.
  /// @pre not locked: long motions take a while to prove; beats and looks are answered meanwhile
  template <typename Start>
  [[nodiscard]] std::uint64_t begin(const std::string& token, const Start& start) {
    std::unique_lock lock(mutex);
    const std::shared_ptr<ControllerLoop> present = working_loop(token);
    lock.unlock();
    KeptRun run = start(*present, take_pending(), [&] {
      // Control may have been lost meanwhile, and be another's: then nothing begins.
      lock.lock();
      static_cast<void>(working_loop(token));
    });
    if (tell_run) tell_run(runs.last() + 1, run.job);
    return runs.add(std::move(run));
  }

  /// A loop that has failed, or whose drive was released, makes room for a new one.
  /// @pre locked, and no other renewal under way
  void renew_loop(std::unique_lock<std::mutex>& lock) {
    const bool was_released = is_release_wished && !runs.is_any_under_way();
    if (loop != nullptr && loop->fault().empty() && !was_released) return;
    if (loop != nullptr) {
      last = look_at(*loop);
      last_cycle = loop->newest_cycle();
      auto cycles = loop->fault_cycles();
      if (!cycles.empty()) fault_cycles = std::move(cycles);
    }
    std::shared_ptr<ControllerLoop> spent = std::exchange(loop, nullptr), made;
    const JointVector rest = last.measured;
    lock.unlock();
    spent.reset();  // its drive has to be free for the next
    try {
      made = make_loop(rest);
    } catch (const MotionError& error) {
      lock.lock();
      last.fault = error.problem().message;
      throw;
    }
    lock.lock();
    if (quits) throw NotInControl("the controller is shutting down");
    loop = std::move(made);
    is_release_wished = false;
  }

  /// @pre locked
  [[nodiscard]] const std::shared_ptr<ControllerLoop>& working_loop(
      const std::string& token) const {
    seat.require(token);
    if (quits) throw NotInControl("the controller is shutting down");
    return loop;  // there is one as long as somebody has control
  }

  const JointLimits limits;
  const MakeLoop make_loop;
  const OnRun tell_run;
  const OnLoss tell_loss;
  const std::chrono::nanoseconds lease;

  std::mutex renewal;        ///< taken before the next one, while control is being taken
  mutable std::mutex mutex;  ///< guards what follows; never held while a motion is proven
  std::condition_variable changed;
  std::shared_ptr<ControllerLoop> loop;  ///< null only where the drive could not be enabled anew
  HostStatus last;                       ///< of the loop before
  LoopCycle last_cycle;                  ///< of the same
  std::vector<LogRecord> fault_cycles;   ///< of the newest loop that failed before
  ControlSeat seat;
  MotionInbox pending;
  RunBook runs{kRunsKept};
  bool is_release_wished = false;
  bool quits = false;

  std::thread watchdog;
};

ArmHost::ArmHost(const JointLimits& limits, MakeLoop make_loop, std::chrono::nanoseconds heartbeat,
                 OnRun on_run, OnLoss on_loss)
    : impl_(std::make_unique<Impl>(limits, std::move(make_loop), heartbeat, std::move(on_run),
                                   std::move(on_loss))) {}

ArmHost::~ArmHost() { shut_down(); }

std::string ArmHost::take_control(const std::string& name) {
  // A drive takes a while to enable: who comes meanwhile is not kept waiting.
  const std::unique_lock renewal(impl_->renewal, std::try_to_lock);
  if (!renewal.owns_lock()) {
    throw NotInControl("another connection is taking control of the arm", {"try again later"});
  }
  std::unique_lock lock(impl_->mutex);
  if (impl_->quits) throw NotInControl("the controller is shutting down");
  if (!impl_->seat.taken()) impl_->renew_loop(lock);
  std::string token = impl_->seat.take(name, steady_clock::now());
  impl_->loop->keep_alive(impl_->lease);
  impl_->changed.notify_all();
  return token;
}

void ArmHost::beat(const std::string& token) {
  std::unique_lock lock(impl_->mutex);
  impl_->seat.require(token);
  // In this order: whoever keeps the seat has told the loop before its lease was over.
  const steady_clock::time_point heard = steady_clock::now();
  impl_->loop->keep_alive(impl_->lease);
  if (impl_->seat.expire(steady_clock::now())) impl_->abandon(lock);
  impl_->seat.beat(token, heard);
}

void ArmHost::give_up_control(const std::string& token) {
  std::unique_lock lock(impl_->mutex);
  impl_->seat.leave(token);
  impl_->abandon(lock);
}

void ArmHost::add_pieces(const std::string& token, std::size_t offset,
                         std::vector<TrajectoryPiece> pieces) {
  const std::lock_guard lock(impl_->mutex);
  impl_->seat.require(token);
  impl_->pending.add(offset, std::move(pieces));
}

std::uint64_t ArmHost::run(const std::string& token) {
  return impl_->begin(token, [](ControllerLoop& loop, auto motion, const auto& last_word) {
    return KeptRun{loop.run(std::move(motion), last_word), nullptr};
  });
}

std::uint64_t ArmHost::follow(const std::string& token) {
  return impl_->begin(token, [](ControllerLoop& loop, auto motion, const auto& last_word) {
    const std::shared_ptr<OpenJob> job = loop.follow(std::move(motion), last_word);
    return KeptRun{job, std::make_shared<OpenRun>(job)};
  });
}

void ArmHost::lengthen(const std::string& token, std::uint64_t run, double leave) {
  const std::shared_ptr<OpenRun> open = impl_->open_run(token, run);
  open->lengthen(impl_->take_pending(), leave);
}

void ArmHost::close(const std::string& token, std::uint64_t run) {
  impl_->open_run(token, run)->close();
}

HandOver ArmHost::hand_over(const std::string& token, std::uint64_t run) {
  return impl_->open_run(token, run)->look();
}

void ArmHost::add_tools(const std::string& token, std::uint64_t run,
                        const std::vector<ToolChange>& changes) {
  const std::lock_guard lock(impl_->mutex);
  impl_->seat.require(token);
  impl_->runs.add_tools(run, changes);
}

std::vector<ToolChange> ArmHost::tools(std::uint64_t run, std::size_t offset,
                                       std::size_t most) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->runs.tools(run, offset, most);
}

void ArmHost::steer(const std::string& token, std::uint64_t run, Steering steering) {
  // The lock is held until the wish is told: it cannot overtake a loss of control.
  const std::lock_guard lock(impl_->mutex);
  impl_->seat.require(token);
  Job& job = *impl_->runs.find(run).job;
  switch (steering) {
    case Steering::kPause:
      return job.pause();
    case Steering::kResume:
      return job.resume();
    case Steering::kStep:
      return job.step();
    case Steering::kBackward:
      return job.backward();
    case Steering::kStop:
      return job.stop(StopCategory::kHold);
    case Steering::kStopAndRelease:
      impl_->is_release_wished = impl_->is_release_wished || !has_ended(job);
      return job.stop(StopCategory::kRelease);
  }
}

void ArmHost::on_input(const std::string& token, std::uint64_t run, const InputReaction& reaction) {
  const std::lock_guard lock(impl_->mutex);
  impl_->seat.require(token);
  impl_->runs.find(run).job->on_input(reaction);
}

void ArmHost::require_control(const std::string& token) const {
  const std::lock_guard lock(impl_->mutex);
  impl_->seat.require(token);
}

void ArmHost::require_power(const std::string& token) const {
  const std::lock_guard lock(impl_->mutex);
  impl_->working_loop(token)->require_power();
}

void ArmHost::set_override(const std::string& token, double share) {
  const std::lock_guard lock(impl_->mutex);
  impl_->working_loop(token)->set_override(share);
}

void ArmHost::jog(const std::string& token, const JointVector& velocity) {
  std::unique_lock lock(impl_->mutex);
  const std::shared_ptr<ControllerLoop> loop = impl_->working_loop(token);
  lock.unlock();
  loop->jog(velocity);
  lock.lock();
  if (impl_->seat.holds(token)) return;
  lock.unlock();
  impl_->end_jog(*loop);
}

void ArmHost::admit_hand(const std::string& token,
                         const std::function<void(const JointVector& measured)>& take) {
  std::unique_lock lock(impl_->mutex);
  const std::shared_ptr<ControllerLoop> loop = impl_->working_loop(token);
  lock.unlock();
  loop->admit_hand([&](const Measurement& now) {
    // Control may have been lost meanwhile, and hands told to let go: then none takes the arm.
    const std::lock_guard again(impl_->mutex);
    static_cast<void>(impl_->working_loop(token));
    take(now.q);
  });
}

void ArmHost::set_override(double share) {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->loop != nullptr) impl_->loop->set_override(share);
}

void ArmHost::switch_outputs(std::uint64_t mask, std::uint64_t values) {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->loop != nullptr) impl_->loop->switch_outputs(mask, values);
}

LoopCycle ArmHost::newest_cycle() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->loop == nullptr ? impl_->last_cycle : impl_->loop->newest_cycle();
}

std::vector<ObservedCycle> ArmHost::observed(std::uint64_t from, std::size_t most) const {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->loop == nullptr) return {};
  return impl_->loop->observed(from, most);
}

HostStatus ArmHost::status() const {
  const std::lock_guard lock(impl_->mutex);
  HostStatus status = impl_->loop == nullptr ? impl_->last : look_at(*impl_->loop);
  status.operator_name = impl_->seat.name();
  status.control_loss = impl_->seat.loss();
  status.run = impl_->runs.last();
  return status;
}

std::vector<LogRecord> ArmHost::fault_cycles() const {
  const std::lock_guard lock(impl_->mutex);
  std::vector<LogRecord> cycles;
  if (impl_->loop != nullptr) cycles = impl_->loop->fault_cycles();
  return cycles.empty() ? impl_->fault_cycles : cycles;
}

std::shared_ptr<Job> ArmHost::job(std::uint64_t run) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->runs.find(run).job;
}

void ArmHost::shut_down() {
  std::shared_ptr<Job> job;
  std::shared_ptr<ControllerLoop> loop;
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->quits = true;
    loop = impl_->loop;
    if (const KeptRun* const newest = impl_->runs.newest()) job = newest->job;
  }
  impl_->changed.notify_all();
  if (job != nullptr) job->stop();
  if (loop != nullptr) impl_->end_jog(*loop);
  while (job != nullptr && !has_ended(*job)) {
    try {
      if (job->wait(kSlice)) break;
    } catch (const MotionError&) {
      break;  // the drive has failed: the fault is told by status()
    }
  }
}

}  // namespace viapoint
