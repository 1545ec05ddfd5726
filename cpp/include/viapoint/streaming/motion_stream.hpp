/// @file
/// A program that is run while it is told.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "viapoint/planning/stream_planner.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {

/// A step that came when the arm had nothing else to do any more.
struct LateStep {
  int step = 0;
  SourceLine source;
  std::uint64_t waited_cycles = 0;  ///< at rest; 0 where the arm only slowed down to rest
};

/// Plans each step as it is told, and hands its motion to the arm: far ahead in large chunks, which
/// are the quickest; when the arm is about to come to its end, all that is certain. Where the next
/// step comes in time the arm goes on without a rest; otherwise it rests on its path, and late()
/// says which step it waited for. A corner is certain when the move after it is known, so the arm
/// waits for that before the corner.
///
/// Nothing here waits: whoever tells the steps calls hand_over() again and again, at least every
/// 50 ms, until the run has ended. The first such call begins the motion.
/// Memory does not grow with the number of steps. Real-time: not. Threads: one at a time.
class MotionStream {
 public:
  /// Where the motion runs: ControllerLoop::follow, or VirtualLoop's.
  using Follow = std::function<std::shared_ptr<Follower>(std::shared_ptr<const Trajectory>)>;

  /// @param beginning where it starts, its tolerance and its robot; steps in it are taken first
  /// @param margin what planning and handing over may take of the motion under way [s]
  /// @throws MotionError as StreamPlanner
  MotionStream(RobotPtr robot, const MotionProgram& beginning, Follow follow, double margin);

  /// Takes the next step. To an arm that is moving it hands over what was certain before a step
  /// that is no output; the step itself only where the arm is about to come to its end. So outputs
  /// that are told right after a move come with it, and have their places before its end, too.
  /// @throws MotionError what is wrong with the step, which then is not taken: no other can follow,
  ///   and the arm rests where the steps before it end; or why the arm does not take up the motion:
  ///   then the run ends where the motion before it ends, and every other call throws the same
  void add(const Step& step);
  /// No step follows. @throws MotionError as add()
  void end();
  /// Hands over what is due. The first call after add() leaves that step time for outputs that
  /// belong to it. @throws MotionError as add()
  void hand_over();

  /// Steps told that the arm has not begun.
  [[nodiscard]] int steps_ahead() const;
  /// True where the steps told so far, as the last hand_over() found, give the arm no motion more:
  /// it is for others to come that it waits, however many are ahead.
  [[nodiscard]] bool wants_steps() const { return tried_ == Need::kNow; }
  /// The run, from the first motion on; null before that.
  [[nodiscard]] const std::shared_ptr<Follower>& run() const { return run_; }
  /// How many steps came late, and the newest of them, at most kKept.
  [[nodiscard]] std::uint64_t late_count() const { return late_count_; }
  [[nodiscard]] const std::vector<LateStep>& late() const { return late_; }
  static constexpr std::size_t kKept = 1000;
  /// What was decided and met since the last call, the newest, at most kKept of each.
  [[nodiscard]] std::vector<CornerOutcome> take_corners();
  [[nodiscard]] std::vector<Problem> take_warnings();

 private:
  /// How soon the arm needs more, and so how much is worth a chunk.
  enum class Need : std::uint8_t { kNone, kLater, kSoon, kNow };

  /// @param may_rest hands over motion that begins at rest on the path, too, if it is time for that
  void hand_over(bool may_rest);
  void hand_over_chunks(bool may_rest);
  void begin(MotionChunk chunk);
  void offer(MotionChunk chunk);
  void keep(MotionChunk& chunk);
  void require_no_trouble() const;
  [[nodiscard]] bool is_decided();
  void note_late();
  [[nodiscard]] double time_left() const;
  /// The arm is about to come to its end: to go on is worth more than an output's place.
  [[nodiscard]] bool is_in_hurry() const;

  StreamPlanner planner_;
  Follow follow_;
  double margin_;
  std::shared_ptr<Follower> run_;
  std::exception_ptr trouble_;  ///< why the arm did not take up a motion
  bool is_offered_ = false;     ///< a motion whose fate is open
  bool is_stop_ = false;        ///< it begins where the arm rests on its path
  bool is_fresh_ = false;       ///< the last step has come since hand_over()
  /// The first step that was told after the arm had all that was certain, if one was; and the one
  /// that the motion handed over last had waited for.
  std::optional<LateStep> awaited_;
  LateStep blamed_;
  Need tried_ = Need::kNone;  ///< that there was too little for
  std::uint64_t waited_ = 0;
  int steps_ = 0;
  double left_then_ = 0.0;  ///< motion that was left when it came [s]
  int last_late_ = -1;
  std::uint64_t late_count_ = 0;
  std::vector<LateStep> late_;
  std::vector<CornerOutcome> corners_;
  std::vector<Problem> warnings_;
};

}  // namespace viapoint
