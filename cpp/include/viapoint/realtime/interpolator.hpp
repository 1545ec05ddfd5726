/// @file
/// The tick: turns a finished motion into one setpoint a cycle.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/nonblocking.hpp"
#include "viapoint/realtime/drive.hpp"
#include "viapoint/realtime/input_gate.hpp"
#include "viapoint/realtime/jog.hpp"
#include "viapoint/realtime/lookahead.hpp"
#include "viapoint/realtime/motion_link.hpp"
#include "viapoint/realtime/motion_log.hpp"
#include "viapoint/realtime/path_return.hpp"
#include "viapoint/realtime/rate_governor.hpp"
#include "viapoint/realtime/timed_outputs.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// What the operator wants of the motion under way.
enum class Wish : std::uint8_t {
  kRun,
  kPause,
  kStop,     ///< category 2: to rest on the path, for good
  kRelease,  ///< category 1: the same, and then the drive is released
  kStep,     ///< to the end of the move under way, then kPause
  kBackward  ///< back along the path, to the motion's start at most
};

/// Runs one motion after another, each from rest to rest, and holds position or jogs between them.
///
/// At full rate the setpoint of cycle k is the trajectory at exactly k cycles of nominal time; the
/// last one is its end point. Override, pause, resume and stop change only the rate at which
/// nominal time runs (RateGovernor): the geometry never changes, and every joint keeps its limits
/// through each change. A wait is a piece of constant position and runs at the rate like the rest;
/// outputs change with the first setpoint of the piece that carries them, or the time they are told
/// before or after that (TimedOutputs).
///
/// A piece that waits for an input begins when that is so (InputGate). Until then the arm rests
/// where it begins, the state is kWaiting, and after the wait's time-out the motion is over
/// (kStopped, input_missed()). A pause holds the clock of the wait.
///
/// Backward it is the mirrored motion that runs, by the same law: it turns at rest, and rests at
/// the motion's start. Outputs are held meanwhile, and on the way forward again until the farthest
/// piece that was reached, so that none is ever switched twice.
///
/// A stop is left to the motion itself where that rests as soon as any stop could, but for a tenth.
///
/// A step ends with the move under way: exactly there and at rest where the path rests between the
/// moves, and where it does not, at rest as soon after it as can be.
///
/// An open motion may get longer while it runs (lengthen()). At its end the arm waits, at rest,
/// until more comes or the motion is closed; closed it is finished there, paused or not.
///
/// While paused the arm may be jogged away. To go on it first returns, in a straight line in joint
/// space (PathReturn), to where it left the path.
///
/// Real-time: all but the constructor is safe; a cycle costs O(joints) whatever the motion's length
/// and however many pieces it passes over (but for the binary search for the piece under way).
/// Threads: one.
class Interpolator {
 public:
  /// Holds `position` until the first begin(). Allocates.
  Interpolator(const JointLimits& limits, std::chrono::nanoseconds cycle,
               const JointVector& position);

  /// Takes a motion that begins where the arm rests, at rest (admit() has checked it). It must stay
  /// alive until active() is false, or until it has been lengthened. @pre !active(), !jogging()
  void begin(const Trajectory& motion, bool open = false) noexcept VIAPOINT_NONBLOCKING;
  /// Goes over to the longer motion, if the one under way is the same for as long as the rate is
  /// decided for, and if the arm is neither on its way back nor behind the new beginning; what that
  /// takes is to wait (kNotYet), or it is too late. @pre active() and open; the two motions and
  /// their first two derivatives agree where they part, up to the certificate's slack
  [[nodiscard]] LinkFate lengthen(const MotionLink& link) noexcept VIAPOINT_NONBLOCKING;
  /// No more comes: the motion ends where it ends.
  void close() noexcept VIAPOINT_NONBLOCKING { open_ = false; }
  /// Where the outputs stand that the next motion begins with. @pre !active()
  void set_outputs(std::uint64_t outputs) noexcept VIAPOINT_NONBLOCKING { outputs_ = outputs; }
  /// Share of the planned speed, clamped to [0, 1]; 0 acts as a pause. Kept between motions.
  void set_override(double share) noexcept VIAPOINT_NONBLOCKING;
  /// What is less counts as 0: so slow a motion would never come to rest in doubles.
  static constexpr double kLeastOverride = 1e-6;
  /// Inputs as measured last, bit i for input i: what the motion waits for. Kept between motions.
  void set_inputs(std::uint64_t inputs) noexcept VIAPOINT_NONBLOCKING { inputs_ = inputs; }
  /// A stop is final for its motion; each kStep is one step more.
  void wish(Wish wish) noexcept VIAPOINT_NONBLOCKING;

  /// Jogs at these joint velocities (n,) [rad/s or m/s] until kJogLease is over, from rest or on
  /// from the jog under way; zero comes to rest at once. Override does not act on it. Ignored while
  /// a motion is active, unless it rests after a wish to pause, and after a fault.
  void jog(const JointVector& velocity) noexcept VIAPOINT_NONBLOCKING;
  /// True where jog() is not ignored.
  [[nodiscard]] bool may_be_jogged() const noexcept;
  /// Brings a jog to rest at once.
  void stop_jog() noexcept VIAPOINT_NONBLOCKING;
  /// True until a jog has come to rest.
  [[nodiscard]] bool jogging() const noexcept { return jog_.active(); }
  /// What keeps the jog, or kept the last one, from doing what was wished.
  [[nodiscard]] JogBlock jog_block() const noexcept { return jog_.block(); }
  /// How long a wish to jog counts without being renewed.
  static constexpr std::chrono::milliseconds kJogLease{250};

  /// Holds this position (n,) from the next tick on, for an arm that was moved by hand. Ignored
  /// while a motion is active or jogging.
  void stand_at(const JointVector& position) noexcept VIAPOINT_NONBLOCKING;

  /// Drops the motion or jog on the spot, for a drive that has failed; then state kFault.
  void abandon() noexcept VIAPOINT_NONBLOCKING;

  /// One cycle: fills in the setpoint due now and moves on. Returns the state it belongs to:
  /// kFinished with the end point, kStopped with the first setpoint at rest after a stop. Jogging
  /// it returns kJogging, and kIdle or kPaused with the first setpoint at rest. Without either it
  /// holds the position and returns the last state again.
  RunState tick(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;

  /// Fills in of `record` what the last tick, which gave `setpoint`, decided: all but the cycle,
  /// the clock's figures and the measurement.
  void describe(const Setpoint& setpoint, LogRecord& record) const noexcept VIAPOINT_NONBLOCKING;

  /// True while the arm rests for an input, or has rested for one when it was stopped or paused.
  [[nodiscard]] bool awaits_input() const noexcept { return motion_ != nullptr && gate_.waits(); }
  /// True where the last motion has ended because an input did not come.
  [[nodiscard]] bool input_missed() const noexcept { return input_missed_; }
  /// The input of both. @pre one of them
  [[nodiscard]] const InputWait& awaited() const noexcept { return gate_.wait(); }
  /// True from begin() until a tick has returned kFinished or kStopped.
  [[nodiscard]] bool active() const noexcept { return motion_ != nullptr; }
  /// Of the last setpoint: nominal time since begin() [s], rate dτ/dt (negative backward), program
  /// step (-1 before the first motion).
  [[nodiscard]] double nominal_time() const noexcept { return left_out_ + shown_.tau; }
  /// Until when the rate is decided [s of nominal time since begin()]: lengthen() finds a motion
  /// that parts before this not yet possible, or too late. 0 without a motion.
  [[nodiscard]] double settled_time() const noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] double rate() const noexcept { return shown_.rate; }
  [[nodiscard]] int move() const noexcept { return move_; }
  [[nodiscard]] RunState state() const noexcept { return run_state_; }
  /// Pieces of the motion that the last tick looked at, for the future: at most kPiecesACycle.
  [[nodiscard]] int pieces_looked_at() const noexcept { return looked_at_; }

  /// Bounds the tick: of a motion that passes over more pieces in a cycle the future stays unknown,
  /// and its rate as it is, until they get sparser.
  static constexpr int kPiecesACycle = 256;

 private:
  [[nodiscard]] bool is_stop() const noexcept;
  [[nodiscard]] bool wants_motion() const noexcept;
  [[nodiscard]] double target() const noexcept;
  [[nodiscard]] double nominal(double way) const noexcept;
  [[nodiscard]] double snapped(double tau) const noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] bool ends_here() const noexcept;
  [[nodiscard]] RunState classify_wait() const noexcept;
  [[nodiscard]] RunState classify() const noexcept;
  void hold(Setpoint& setpoint) const noexcept VIAPOINT_NONBLOCKING;
  RunState tick_jog(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  RunState tick_return(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  RunState tick_motion(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  RunState tick_waiting(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  RunState tick_at_gate(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  void stop_at_gate() noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] std::uint64_t outputs_with(std::uint64_t timed) const noexcept VIAPOINT_NONBLOCKING;
  void switch_outputs(bool is_ahead) noexcept VIAPOINT_NONBLOCKING;
  void turn_where_wanted() noexcept VIAPOINT_NONBLOCKING;
  void rest_at(double way) noexcept VIAPOINT_NONBLOCKING;
  void end_step(std::size_t piece) noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] double shortest_stop() const noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] double place_to_rest() const noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] bool rests_at_start_of(std::size_t piece) const noexcept VIAPOINT_NONBLOCKING;
  void enter_piece(std::size_t piece) noexcept VIAPOINT_NONBLOCKING;
  void evaluate(double curvature, Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  void move_on() noexcept VIAPOINT_NONBLOCKING;

  static constexpr int kNoMove = -1;
  static constexpr double kNoPlace = std::numeric_limits<double>::infinity();

  JointLimits limits_;
  double cycle_;
  double longest_stop_ = 0.0;  ///< that shortest_stop() may ever say [s]
  RateGovernor governor_;
  Jog jog_;
  int jog_cycles_;  ///< that a wish counts for
  Lookahead lookahead_;
  PathReturn return_;
  TimedOutputs timed_outputs_;
  InputGate gate_;
  bool input_missed_ = false;
  bool off_path_ = false;  ///< jogged away while paused, or on the way back
  bool open_ = false;      ///< more may come
  bool waits_ = false;     ///< at the end of an open motion
  bool may_go_back_ = true;
  /// τ at which the motion itself rests, where the stop under way leaves it to that.
  double rest_place_ = kNoPlace;
  double fresh_ = 0.0;     ///< τ at which the motion goes on from rest: any rate may begin there
  double left_out_ = 0.0;  ///< nominal time of what was left out at the beginning [s]
  const Trajectory* motion_ = nullptr;
  std::size_t piece_ = 0;
  std::size_t farthest_piece_ = 0;
  double farthest_ = 0.0;  ///< τ
  Direction direction_ = Direction::kForward;
  /// Along the way in `direction_`: backward, τ since the motion's end, and rates count positive.
  RateState now_;
  /// At a constant rate τ is anchor + n cycle ρ: a product, so that nothing adds up.
  double anchor_ = 0.0;
  std::uint64_t since_anchor_ = 0;

  double override_ = 1.0;
  Wish wish_ = Wish::kRun;
  int step_move_ = kNoMove;  ///< that the step is to end with
  RunState run_state_ = RunState::kIdle;
  RateState shown_;  ///< by nominal time
  int move_ = -1;
  int looked_at_ = 0;
  std::uint64_t cycles_ = 0;
  std::uint64_t inputs_ = 0;
  std::uint64_t outputs_ = 0;
  std::uint64_t outputs_before_ = 0;  ///< when the motion began
  JointVector position_;
};

}  // namespace viapoint
