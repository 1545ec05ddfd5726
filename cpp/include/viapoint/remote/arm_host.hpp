/// @file
/// An arm that several programs look at and one commands: what a server offers, without the
/// network.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/input_reaction.hpp"
#include "viapoint/realtime/loop_cycle.hpp"
#include "viapoint/remote/hand_over.hpp"
#include "viapoint/remote/tool_change.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// What anybody may know of the arm.
struct HostStatus {
  JointVector setpoint;       ///< (n,) [rad or m]
  JointVector measured;       ///< (n,) [rad or m]
  std::int64_t stamp = 0;     ///< of the loop's clock, of the cycle that measured it [ns]
  std::uint64_t inputs = 0;   ///< measured in that cycle, bit i is input i
  std::uint64_t outputs = 0;  ///< told in that cycle, bit i is output i
  double override_share = 1.0;
  std::uint64_t cycle = 0;  ///< number of that cycle, as ControllerLoop::observed counts
  bool busy = false, jogging = false;
  bool guided = false;    ///< as ControllerLoop::guided
  std::string jog_block;  ///< as ControllerLoop::jog_block
  std::string fault;      ///< as ControllerLoop::fault
  std::vector<std::string> shortcomings;
  std::string operator_name;  ///< who has control; empty: nobody
  std::string control_loss;   ///< how control was lost last; empty: it never was
  std::uint64_t run = 0;      ///< number of the last run; 0: none yet
};

/// What the operator may wish of a run.
enum class Steering : std::uint8_t { kPause, kResume, kStep, kBackward, kStop, kStopAndRelease };

/// Owns the loop. One operator at a time moves the arm (ControlSeat); when he falls silent or
/// leaves, a run under way pauses on its path, a jog ends, and the run waits for what the next
/// operator says.
///
/// Threads: any, at once. Real-time: not; the loop's own thread never waits for anything here.
class ArmHost {
 public:
  /// Builds the loop with its drive. Called at first and, after a fault or release, when the next
  /// operator takes control. @param rest where the arm stood last; empty at first
  using MakeLoop = std::function<std::unique_ptr<ControllerLoop>(const JointVector& rest)>;

  /// Told of every run as it begins, its number and the run; it has to be quick.
  using OnRun = std::function<void(std::uint64_t number, const std::shared_ptr<Job>& job)>;

  /// Told when nobody has control any more; it has to be quick, and asks nothing of the host.
  using OnLoss = std::function<void()>;

  /// @param heartbeat an operator has to be heard of within it [> 0]: what moves has begun to stop
  ///        when so much time has passed since the last beat
  /// @throws what `make_loop` throws
  ArmHost(const JointLimits& limits, MakeLoop make_loop, std::chrono::nanoseconds heartbeat,
          OnRun on_run = {}, OnLoss on_loss = {});
  /// As shut_down().
  ~ArmHost();
  ArmHost(const ArmHost&) = delete;
  ArmHost& operator=(const ArmHost&) = delete;

  /// Takes control, and returns the token that commands carry. After a fault or a release the
  /// drive is enabled anew. @throws NotInControl when another has it, or is just taking it;
  /// kDriveFault
  [[nodiscard]] std::string take_control(const std::string& name);
  /// @throws NotInControl, as all that follow with a token
  void beat(const std::string& token);
  void give_up_control(const std::string& token);

  /// Collects a motion part by part.
  /// @param offset how many pieces of it came before; 0 forgets what there is
  /// @throws MotionError(kBadArgument) for another offset, and beyond kMaxPieces
  void add_pieces(const std::string& token, std::size_t offset,
                  std::vector<TrajectoryPiece> pieces);
  static constexpr std::size_t kMaxPieces = 100'000;
  /// Proves the motion collected and runs it; returns the run's number, from 1.
  /// @throws MotionError of ControllerLoop::run, with the certificate's first problem
  [[nodiscard]] std::uint64_t run(const std::string& token);
  /// The same of a motion that gets longer while it runs, of which the one collected is the
  /// beginning. When its operator is lost the run takes nothing more: it can be resumed to the end
  /// of what there is.
  [[nodiscard]] std::uint64_t follow(const std::string& token);
  /// Proves the motion collected, and hands it over as Follower::lengthen.
  /// @throws MotionError(kBadArgument) for a run that is not kept, or that follow() did not begin
  void lengthen(const std::string& token, std::uint64_t run, double leave);
  /// As Follower::close. @throws MotionError as lengthen()
  void close(const std::string& token, std::uint64_t run);
  /// @throws MotionError as lengthen()
  [[nodiscard]] HandOver hand_over(const std::string& token, std::uint64_t run);
  /// Keeps which tools a run moves, behind those told before.
  /// @throws MotionError(kBadArgument) beyond kMaxTools, and as steer()
  void add_tools(const std::string& token, std::uint64_t run,
                 const std::vector<ToolChange>& changes);
  /// As Job's; a run that has ended stays as it is.
  /// @throws MotionError(kBadArgument) for a run that is not kept
  void steer(const std::string& token, std::uint64_t run, Steering steering);
  /// As Job::on_input. @throws MotionError of that, and as steer()
  void on_input(const std::string& token, std::uint64_t run, const InputReaction& reaction);
  /// Nothing but whether the token has control.
  void require_control(const std::string& token) const;
  /// The same, and whether the drive has power. @throws MotionError of
  ///   ControllerLoop::require_power
  void require_power(const std::string& token) const;
  /// @throws MotionError of ControllerLoop::set_override
  void set_override(const std::string& token, double share);
  /// @throws MotionError of ControllerLoop::jog
  void jog(const std::string& token, const JointVector& velocity);
  /// As ControllerLoop::admit_hand; who has control keeps it until `take` has come back, which asks
  /// nothing of the host. @param take is told where the arm was measured last, (n,)
  void admit_hand(const std::string& token,
                  const std::function<void(const JointVector& measured)>& take);

  // For a panel beside the operator, which begins no motion and needs no token. While the loop is
  // built anew there is nothing to turn, and the last cycle is that of the loop before.
  /// @throws MotionError of ControllerLoop::set_override
  void set_override(double share);
  /// As ControllerLoop::switch_outputs.
  void switch_outputs(std::uint64_t mask, std::uint64_t values);
  [[nodiscard]] LoopCycle newest_cycle() const;
  /// As ControllerLoop::observed; empty while the loop is built anew, whose cycles count from 1.
  [[nodiscard]] std::vector<ObservedCycle> observed(std::uint64_t from, std::size_t most) const;

  [[nodiscard]] HostStatus status() const;
  /// The last cycles before the newest fault, as ControllerLoop::fault_cycles, also when the drive
  /// is enabled anew; empty: nothing has failed.
  [[nodiscard]] std::vector<LogRecord> fault_cycles() const;
  /// A run and its log; the newest kRunsKept are kept.
  /// @throws MotionError(kBadArgument) for another number
  [[nodiscard]] std::shared_ptr<Job> job(std::uint64_t run) const;
  static constexpr std::uint64_t kRunsKept = 2;
  /// Of what add_tools() was told, at most so many from `offset` on. @throws MotionError as job()
  [[nodiscard]] std::vector<ToolChange> tools(std::uint64_t run, std::size_t offset,
                                              std::size_t most) const;

  /// Stops a run on its path and a jog, and waits for the rest; nobody moves the arm any more.
  void shut_down();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viapoint
