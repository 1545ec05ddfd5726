/// @file
/// The real-time thread's work: one cycle after another.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <limits>

#include "realtime/cycle_history.hpp"
#include "realtime/jog_channel.hpp"
#include "realtime/measurement_tape.hpp"
#include "realtime/output_panel.hpp"
#include "realtime/snapshot.hpp"
#include "viapoint/realtime/clock.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/drive.hpp"
#include "viapoint/realtime/guard.hpp"
#include "viapoint/realtime/interpolator.hpp"
#include "viapoint/realtime/motion_queue.hpp"

namespace viapoint {

/// How long the arm may move from the cycle that sees it, and which lease it is: 0 before the
/// first.
struct Lease {
  std::uint32_t number = 0;
  std::uint32_t microseconds = 0;
};
static_assert(std::atomic<Lease>::is_always_lock_free);

/// What the loop's threads share. Each member says who writes it.
struct LoopChannels {
  explicit LoopChannels(int joints) : snapshot(joints), tape(joints) {}

  MotionQueue motions;
  /// Eight seconds at 500 Hz for the companion to come round.
  boost::lockfree::spsc_queue<LogRecord, boost::lockfree::capacity<4096>> log;
  Snapshot snapshot;                        ///< tick
  MeasurementTape tape;                     ///< tick
  JogChannel jog;                           ///< ordinary threads, one at a time
  OutputSwitches switches;                  ///< ordinary threads
  std::atomic<bool> jogging{false};         ///< tick
  std::atomic<JogBlock> jog_block{};        ///< tick
  std::atomic<bool> guided{false};          ///< tick: a hand moves the arm
  std::atomic<double> override_share{1.0};  ///< ordinary threads
  std::atomic<Lease> lease{};               ///< ordinary threads
  std::atomic<bool> quit{false};            ///< ordinary threads
  std::atomic<bool> faulted{false};         ///< tick
  // Written by the tick before `faulted`, and never after it.
  Breach breach;
  DriveStatus last_status = DriveStatus::kOk;
  CycleHistory<ControllerLoop::kFaultCycles> history;
  std::atomic<bool> released{false};  ///< tick: a category 1 stop has ended
};

/// Exactly one setpoint a cycle, in step with the clock. After a late wake-up the next setpoint is
/// the next of the motion, and the cycles that were slept through are left out of the grid: the arm
/// is late then, and never jumps. Threads: one.
class CycleRunner {
 public:
  /// @param start the arm's position, at rest
  CycleRunner(Drive& drive, Clock& clock, LoopChannels& channels, const JointLimits& limits,
              const LoopOptions& options, const Measurement& start);

  /// Until channels.quit.
  void run() noexcept;
  /// Waits for the next cycle of the clock, and does its work.
  void cycle() noexcept;

 private:
  void wait_for_cycle() noexcept;
  void do_cycle() noexcept VIAPOINT_NONBLOCKING;
  /// Acts on a wish to jog, and says what came of it.
  void jog() noexcept VIAPOINT_NONBLOCKING;
  void take_wish() noexcept VIAPOINT_NONBLOCKING;
  /// Does what the motion is to do about an input, if it was measured so.
  void take_input(std::atomic<InputReaction>& place) noexcept VIAPOINT_NONBLOCKING;
  /// Brings to rest what moves on behalf of somebody who is not heard of any more.
  void hold_lease() noexcept VIAPOINT_NONBLOCKING;
  /// Goes over to the longer motion that an open one has become, and to its end.
  void take_link() noexcept VIAPOINT_NONBLOCKING;
  void begin_next() noexcept VIAPOINT_NONBLOCKING;
  /// Gives back a motion that was queued while the drive failed or was released.
  void refuse_next() noexcept VIAPOINT_NONBLOCKING;
  /// Lets the setpoints follow an arm that is moved by hand.
  void follow_hand() noexcept VIAPOINT_NONBLOCKING;
  /// The guard's last word on the setpoint; true where the arm rests after a breach.
  [[nodiscard]] bool guard() noexcept VIAPOINT_NONBLOCKING;
  /// The setpoints are the guard's own: whatever the interpolator would do.
  [[nodiscard]] bool stops_off_path() const noexcept { return off_path_ && !fails_; }
  /// Ends everything: nothing is told the drive any more.
  void fail(DriveStatus status) noexcept VIAPOINT_NONBLOCKING;
  /// Tells whoever looks on.
  void show() noexcept VIAPOINT_NONBLOCKING;
  void record(std::int64_t compute) noexcept VIAPOINT_NONBLOCKING;
  void finish() noexcept VIAPOINT_NONBLOCKING;
  void let_others_run() noexcept;

  Drive& drive_;
  Clock& clock_;
  LoopChannels& channels_;
  Interpolator interpolator_;
  Guard guard_;
  std::int64_t cycle_;
  std::int64_t due_ = 0, woke_ = 0;
  std::int64_t late_cycles_ = 0;  ///< whole cycles that the last wake-up came late
  QueuedMotion* motion_ = nullptr;
  std::uint32_t lease_ = 0;  ///< number of the last lease seen
  std::int64_t alive_until_ = std::numeric_limits<std::int64_t>::max();
  NumberedWish wish_;  ///< of the motion, as far as it has been acted on
  /// The last setpoint is out. The run ends with the exchange after it, which measures where that
  /// setpoint has brought the arm.
  bool arriving_ = false;
  bool off_path_ = false;    ///< the guard stops each joint
  bool fails_ = false;       ///< everything ends with this cycle
  bool is_resting_ = false;  ///< after a breach, since the cycle before
  std::uint64_t cycle_of_run_ = 0;
  JointVector wished_;  ///< joint velocities
  Setpoint setpoint_;
  OutputPanel outputs_;
  Measurement measurement_;
  LoopCycle shown_;
  LogRecord record_;
};

}  // namespace viapoint
