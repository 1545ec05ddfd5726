/// @file
/// Plans a program while it is being told: finished, proven motion for what is known so far, and
/// the way on as more moves come.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "viapoint/planning/motion_planner.hpp"

namespace viapoint {

/// A stretch of motion that always ends at rest on the path. Whoever runs it goes over to the next
/// chunk at that one's `begin`, if it is there by then; otherwise the arm comes to rest, on the
/// path and within every limit.
struct MotionChunk {
  /// Certified, from the state in which the chunk before is left (the first: from rest) to rest.
  /// Its certificate holds, and proves the step from that state to this motion with the rest.
  Trajectory motion;
  /// When the chunk before is left for this one [s of its nominal time]: its duration where the arm
  /// rests in between. 0 for the first.
  double begin = 0.0;
  bool last = false;                   ///< the program ends with it
  std::vector<CornerOutcome> corners;  ///< decided since the chunk before
  std::vector<Problem> warnings;       ///< met since the chunk before
  /// Where a process speed is not held, known since the chunk before: a chunk is looked at when it
  /// is known when it is left. Times count from the beginning of the first chunk [s, nominal].
  std::vector<ProcessStretch> process_stretches;
};

/// Takes the steps of a program one by one and hands out its motion in chunks. What is kept does
/// not grow with the program, nor does the cost of a move.
///
/// The path is that of MotionPlanner::plan() of the same steps: each corner is decided once, when
/// the moves that it hangs on are known (the two that it joins, and whether one follows them), and
/// stays. Only the timing is made in windows: what lies behind the place where the arm leaves a
/// chunk is timed anew with what has come since.
/// Real-time: not. Threads: one at a time.
class StreamPlanner {
 public:
  /// @param program where it begins, its tolerance and its robot; steps in it are taken first
  /// @throws MotionError for a start, tolerance or fingerprint that plan() would refuse
  StreamPlanner(RobotPtr robot, const MotionProgram& program);
  ~StreamPlanner();
  StreamPlanner(StreamPlanner&&) noexcept;
  StreamPlanner& operator=(StreamPlanner&&) noexcept;

  /// Takes the next step. @throws MotionError: what is wrong with it, as plan() says it. That step
  /// is not taken, and the program ends before it: what was taken is still handed out.
  void add(const Step& step);
  /// From now on straight lines are taken as they come, however near to one line: none waits for
  /// lines that may be told only when it has been run.
  void merge_nothing();
  /// No step follows: the arm comes to rest at the last point.
  void end();
  /// The next chunk, if enough has come for one, or all that will come.
  /// @param not_before the chunk handed out last will not be left before this [s of its nominal
  ///        time]: where the arm has got to, and what handing over takes
  /// @param at_once a chunk of whatever is certain, however little is new
  /// @param may_rest hands out a chunk that the arm has to rest before, too; otherwise it is tried
  ///        again with what comes
  [[nodiscard]] std::optional<MotionChunk> next(double not_before = 0.0, bool at_once = false,
                                                bool may_rest = true);
  /// Instead of the chunk handed out last, when it came too late: the arm rests at the end of the
  /// one before, and this one goes on along the same way from there. Without corners and warnings,
  /// which the other one has. @pre the chunk handed out last was to begin before that end
  [[nodiscard]] MotionChunk after_rest();
  /// True when all has been handed out.
  [[nodiscard]] bool done() const;
  /// How often so far the arm had to rest where a longer view would have gone on.
  [[nodiscard]] int stops() const;

 private:
  class Line;
  std::unique_ptr<Line> line_;
};

}  // namespace viapoint
