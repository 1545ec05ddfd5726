/// @file
/// What ordinary threads have to do with the loop.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "realtime/cycle_runner.hpp"
#include "realtime/loop_job.hpp"
#include "realtime/powered_drive.hpp"
#include "viapoint/realtime/clock.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {

/// Admits runs and jogs, carries logs out of the real-time part, and says what has failed. The
/// cycles themselves are somebody else's: a thread's, or a caller's in virtual time.
/// Real-time: not. Threads: any, but for see_to().
class RunDesk {
 public:
  /// Enables the drive. @throws MotionError as ControllerLoop's constructor
  RunDesk(std::unique_ptr<Drive> drive, const JointLimits& limits, const LoopOptions& options,
          std::unique_ptr<Clock> clock);

  /// As ControllerLoop::run, and with `open` as ControllerLoop::follow.
  [[nodiscard]] std::shared_ptr<LoopJob> run(std::shared_ptr<const Trajectory> trajectory,
                                             bool open,
                                             const std::function<void()>& last_word = {});
  /// As ControllerLoop::jog.
  void jog(const JointVector& velocity);
  /// As ControllerLoop::admit_hand.
  void admit_hand(const std::function<void(const Measurement&)>& take);
  /// A jog that is under way, or wished and not begun. A drive that failed or was released jogs no
  /// more.
  [[nodiscard]] bool jogs() const;
  /// A hand moves the arm, or is about to.
  [[nodiscard]] bool is_guided() const;
  /// As ControllerLoop::set_override.
  void set_override(double share);
  /// What has failed; empty while nothing has.
  [[nodiscard]] std::string fault();
  /// As ControllerLoop::require_power.
  void require_power();
  /// As ControllerLoop::fault_cycles.
  [[nodiscard]] std::vector<LogRecord> fault_cycles() const;
  /// The last run; null before the first.
  [[nodiscard]] std::shared_ptr<LoopJob> job() const;

  /// Carries the log out, and takes back what is spent. Threads: one at a time.
  void see_to();

  [[nodiscard]] const JointLimits& limits() const { return limits_; }
  [[nodiscard]] Clock& clock() { return *clock_; }
  [[nodiscard]] LoopChannels& channels() { return channels_; }
  [[nodiscard]] const LoopChannels& channels() const { return channels_; }
  [[nodiscard]] CycleRunner& runner() { return runner_; }
  /// One thread at a time feeds the queue, and nobody else while this is held.
  [[nodiscard]] std::mutex& admission() { return admission_; }

 private:
  /// @pre admission is held; @throws MotionError(kDriveFault, kBusy) unless the arm has power and
  ///   neither a run nor a jog moves it
  void require_rest();
  void require_no_hand() const;
  [[nodiscard]] bool busy() const;
  void await_log_of_ended_run() const;
  [[nodiscard]] std::string fault_of_run();
  void drain_log();

  JointLimits limits_;
  std::size_t log_records_;
  PoweredDrive powered_;
  std::unique_ptr<Clock> clock_;
  LoopChannels channels_;
  CycleRunner runner_;

  std::mutex admission_;
  mutable std::mutex job_mutex_;  ///< guards the pointer
  std::shared_ptr<LoopJob> job_;  ///< written under both locks
};

}  // namespace viapoint
