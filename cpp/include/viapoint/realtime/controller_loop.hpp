/// @file
/// The 2 ms loop: a thread of its own with the machine's clock, or virtual time in the caller's.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/realtime/clock.hpp"
#include "viapoint/realtime/drive.hpp"
#include "viapoint/realtime/guard.hpp"
#include "viapoint/realtime/input_reaction.hpp"
#include "viapoint/realtime/loop_cycle.hpp"
#include "viapoint/realtime/motion_link.hpp"
#include "viapoint/realtime/motion_log.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

struct LoopOptions {
  std::chrono::nanoseconds cycle{2'000'000};
  int priority = 80;        ///< SCHED_FIFO
  bool lock_memory = true;  ///< mlockall
  /// Keep the machine's processors out of deep sleep: /dev/cpu_dma_latency at 0. Costs power.
  bool keep_awake = true;
  std::optional<int> processor;  ///< that the loop's thread stays on, from 0; none: any
  /// Records that a run keeps, the newest, at least 1. These are 16 minutes of motion at 500 Hz,
  /// and then about 400 MB; rests take none.
  std::size_t log_records = 500'000;
  GuardOptions guard;
};

/// Figures of one run.
struct RunReport {
  std::uint64_t cycles = 0;    ///< of the run, in the log or not
  std::uint64_t overruns = 0;  ///< cycles that woke a whole cycle late or more
  double latency_p50 = 0.0, latency_p99 = 0.0, latency_max = 0.0;  ///< wake-up [s]
  double compute_p50 = 0.0, compute_p99 = 0.0, compute_max = 0.0;  ///< the tick itself [s]
  // Quantiles are over all cycles and at most 1/64 too large; the largest are exact.
  double wall_time = 0.0;  ///< first to last cycle [s]
  /// Cycles of the clock that overruns slept through: the run is later by so many.
  std::uint64_t missed_cycles = 0;
  std::uint64_t lost_records = 0;  ///< cycles that found no room in the log, or were pushed out
  /// Cycles at rest that left no record, because a rest leaves only its first two.
  std::uint64_t rested_cycles = 0;
};

/// How a stop ends (IEC 60204-1, 9.2.2): both come to rest on the path. Category 0, power that goes
/// at once, is the drive's; the loop reports it (DriveStatus::kPowerLost).
enum class StopCategory : std::uint8_t {
  kRelease = 1,  ///< then the drive is released: the arm has to be connected anew
  kHold = 2,     ///< the arm holds its position, under power
};

/// How far a run is. Threads: any ordinary.
class Progress {
 public:
  virtual ~Progress() = default;
  [[nodiscard]] virtual RunState state() const = 0;
  [[nodiscard]] virtual double nominal_time() const = 0;  ///< progress [s]
  [[nodiscard]] virtual double duration() const = 0;      ///< nominal [s]
  [[nodiscard]] virtual int move() const = 0;
};

/// One motion under way. All methods from any ordinary thread. Once it has ended there is nothing
/// left to pause, resume or stop: such a wish changes nothing.
class Job : public virtual Progress {
 public:
  /// True when the run ended within `timeout` [s]: when the drive has measured the cycle after the
  /// last setpoint was sent. @throws MotionError(kDriveFault) on a fault; kInputTimeout where the
  /// run has ended because an input did not come in the time its program gives it
  virtual bool wait(double timeout) = 0;
  virtual void pause() = 0;
  /// On along the path; from where a jog has brought the arm it first returns to the path.
  virtual void resume() = 0;
  /// On to the end of the move under way, and then to rest: there, or soon after it where the
  /// motion passes the end at speed.
  virtual void step() = 0;
  /// Back along the path, to the motion's start at most, until another wish. Outputs are held.
  virtual void backward() = 0;
  /// To rest on the path; then state kStopped.
  virtual void stop(StopCategory category = StopCategory::kHold) = 0;
  /// Pauses, resumes or stops (kHold) by itself on an input, in the cycle after the drive has
  /// reported it. One reaction for each of the three, the newest; without an input it is taken
  /// back.
  /// @throws MotionError(kBadArgument) for another input or wish
  virtual void on_input(const InputReaction& reaction) = 0;
  /// The input for which the arm rests on its path now, if it does; the time-out to about seven
  /// digits.
  [[nodiscard]] virtual std::optional<InputWait> awaited() const = 0;
  [[nodiscard]] virtual std::uint64_t overruns() const = 0;
  /// The cycles so far, but for rests from their third cycle on and for lost records: report()
  /// counts both. Complete after wait(). Copies the log.
  [[nodiscard]] virtual std::vector<LogRecord> log() const = 0;
  /// A part of the same: at most `count` records, from cycle `from` on.
  [[nodiscard]] virtual std::vector<LogRecord> log(std::uint64_t from, std::size_t count) const = 0;
  /// Takes as long for a long run as for a short one.
  [[nodiscard]] virtual RunReport report() const = 0;
};

/// Takes up motion that follows on what it runs. Where nothing more has come the arm rests at the
/// end of what there is (RunState::kWaiting). Progress::duration() is that end, and nominal times
/// go on from the stream's beginning.
class Follower : public virtual Progress {
 public:
  /// Hands over what follows: `next` begins where the motion handed over before is left, at `leave`
  /// [s of that one's own time], or where it rests at its end. The arm takes it up in the next
  /// cycle, as long as it is not too late (fate()).
  /// @throws MotionError(kBusy) while the fate of the one before is open, or after close(); what a
  ///   certificate made anew of `next` and of the step to it does not keep; kBadArgument for a
  ///   `leave` that is not within the motion
  /// Threads: one at a time.
  virtual void lengthen(std::shared_ptr<const Trajectory> next, double leave) = 0;
  /// Of the last motion handed over. A run that has ended takes nothing any more: kTooLate.
  /// Threads: the one that hands over.
  [[nodiscard]] virtual LinkFate fate() = 0;
  /// Nothing more comes: the run ends where it ends.
  virtual void close() = 0;
  /// Before this a motion handed over now would be too late, at the present speed [s of the time of
  /// the motion handed over last]; it may be negative. Threads: the one that hands over.
  [[nodiscard]] virtual double earliest_leave() const = 0;
  /// How long the arm has waited for more, altogether [cycles].
  [[nodiscard]] virtual std::uint64_t waited_cycles() const = 0;
};

/// A motion under way that gets longer while it runs.
class OpenJob : public Job, public Follower {};

/// Owns the drive, the interpolator and the thread. The thread runs while the arm is connected
/// (holding position when idle). Destruction brings a run to rest on its path first.
class ControllerLoop {
 public:
  /// Enables the drive and starts the loop thread.
  /// @throws MotionError(kDriveFault) when the drive cannot be enabled, or a thread not be created;
  ///   kBadArgument for options and for joints that do not fit the drive
  ControllerLoop(std::unique_ptr<Drive> drive, const JointLimits& limits,
                 const LoopOptions& options = {},
                 std::unique_ptr<Clock> clock = std::make_unique<MonotonicClock>());
  ~ControllerLoop();
  ControllerLoop(const ControllerLoop&) = delete;
  ControllerLoop& operator=(const ControllerLoop&) = delete;

  /// Admits the motion and begins it at the next cycle. Refused before anything moves: a
  /// certificate (made anew here, from the pieces) that does not hold, kNotAtStart when the arm
  /// rests farther than 1e-6 rad or m from the motion's first point, kNotAtRest, kBusy (also while
  /// the arm jogs).
  /// @param last_word called when all is proven, and the run begins next; what it throws refuses it
  [[nodiscard]] std::shared_ptr<Job> run(std::shared_ptr<const Trajectory> trajectory,
                                         const std::function<void()>& last_word = {});
  /// The same with a motion that gets longer while it runs, of which this is the beginning.
  [[nodiscard]] std::shared_ptr<OpenJob> follow(std::shared_ptr<const Trajectory> first,
                                                const std::function<void()>& last_word = {});
  /// Hold-to-run: joint velocities (n,) [rad/s or m/s] for the next 250 ms; calling again renews
  /// them, zero or silence brings the arm to rest within its limits. Joints stop at their position
  /// limits by themselves, the arm before its coupled limits. Refused: kBusy while a run is under
  /// way, unless it rests after Job::pause(); kVelocityLimit; kBadArgument; kDriveFault. The
  /// override does not act on it.
  void jog(const JointVector& velocity);
  /// Lets a hand take an arm at rest (Drive::is_held): no run, jog or other hand begins meanwhile.
  /// @param take called, with what was measured last, when nothing moves the arm; it has to be
  ///   quick, and what it throws refuses the hand
  /// @throws MotionError(kBusy) while a run or a jog is under way; kDriveFault as require_power()
  void admit_hand(const std::function<void(const Measurement&)>& take);
  /// True until a jog has come to rest; no run is admitted meanwhile.
  [[nodiscard]] bool jogging() const;
  /// What keeps the jog, or kept the last one, from doing what was wished; empty where nothing
  /// does.
  [[nodiscard]] std::string jog_block() const;
  /// From the first call on the arm moves only for as long as this is called again within `lease`
  /// [of the loop's clock, at most an hour]: after that the loop itself pauses what runs, and what
  /// begins or is resumed, and ends a jog. Zero: at once. For who moves the arm on somebody's
  /// behalf. The time counts from the next cycle. Threads: any.
  void keep_alive(std::chrono::nanoseconds lease);
  /// Share of the planned speed in [0, 1]; applies to this run and the next ones.
  void set_override(double share);
  [[nodiscard]] double override_share() const;
  /// Switches outputs by hand from the next cycle on, at rest or in motion. Each output stays as
  /// whoever changed it last left it: a hand, or a step of the program that changes it.
  /// @param mask which outputs, bit i for output i; @param values on or off
  /// Threads: any.
  void switch_outputs(std::uint64_t mask, std::uint64_t values);
  /// The cycle last done. Threads: any; the loop never waits for who asks.
  [[nodiscard]] LoopCycle newest_cycle() const;
  /// What was measured from cycle number `from` on, in order, `most` cycles at most. The last 4096
  /// are kept: those before are left out. Threads: any; the loop never waits for who asks.
  [[nodiscard]] std::vector<ObservedCycle> observed(std::uint64_t from, std::size_t most) const;
  /// What the drive last measured.
  [[nodiscard]] Measurement measured() const;
  /// True while a hand moves the arm (DriveStatus::kGuided), or is about to (Drive::is_held): the
  /// setpoint is where it is measured, and runs and jogs are refused (kBusy). Never after a fault.
  [[nodiscard]] bool guided() const;
  [[nodiscard]] bool busy() const;
  /// Where the loop's set-point rests now.
  [[nodiscard]] JointVector position() const;
  /// What has failed, in one sentence; empty while nothing has. After a fault nothing moves any
  /// more, and the loop has to be built anew.
  [[nodiscard]] std::string fault() const;
  /// For what would else be wished in vain. @throws MotionError(kDriveFault) after a fault, and
  ///   after a stop that has released the drive
  void require_power() const;
  /// The last cycles before the fault, at most kFaultCycles, the oldest first; empty while nothing
  /// has failed.
  [[nodiscard]] std::vector<LogRecord> fault_cycles() const;
  static constexpr int kFaultCycles = 50;
  /// One line each: what real-time right could not be had and what would give it. Empty: all had.
  [[nodiscard]] std::vector<std::string> shortcomings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Throws the first reason why `trajectory` must not run under `limits` from `position`.
void admit(const Trajectory& trajectory, const JointLimits& limits, const JointVector& position);

/// A command of a simulated run.
struct TimedCommand {
  enum class Kind { kOverride, kPause, kResume, kStop, kStep, kBackward, kJog, kInput };
  double time = 0.0;  ///< [s] from the start of the run
  Kind kind = Kind::kOverride;
  double value = 0.0;      ///< of kOverride; of kInput 1 for on, 0 for off
  JointVector velocity{};  ///< of kJog, as ControllerLoop::jog; it counts for 250 ms and in a pause
  int input = 0;           ///< of kInput, 0 to 63; all are off at first
};

/// The same Interpolator in virtual time, without thread or drive: one record a cycle, until the
/// motion has ended or rests for good. A motion paused and never resumed ends when it rests; so do
/// a step, the way back, and a wait for an input that never comes.
[[nodiscard]] std::vector<LogRecord> simulate(const Trajectory& trajectory,
                                              const JointLimits& limits,
                                              std::vector<TimedCommand> commands,
                                              std::chrono::nanoseconds cycle);

/// Throws why an arm with these limits cannot be asked to jog at `velocity` (n,).
void admit_jog(const JointVector& velocity, const JointLimits& limits);

/// A call of ControllerLoop::jog in a simulated one.
struct TimedJog {
  double time = 0.0;  ///< [s] from the start
  JointVector velocity;
};

/// Jogs the same Interpolator in virtual time: one record a cycle, from the first cycle to the one
/// in which the arm rests after the last call. Each call counts for Interpolator::kJogLease.
/// @param start where the arm rests, (n,)
/// @throws MotionError(kBadArgument, kVelocityLimit)
[[nodiscard]] std::vector<LogRecord> simulate_jog(const JointLimits& limits,
                                                  const JointVector& start,
                                                  std::vector<TimedJog> calls,
                                                  std::chrono::nanoseconds cycle);

}  // namespace viapoint
