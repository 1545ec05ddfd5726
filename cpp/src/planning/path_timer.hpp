/// @file
/// Times a path piece by piece as it becomes known, in windows: each is timed from rest to rest,
/// and the one under way is left for the next where the two hardly differ. So what a piece costs
/// does not hang on how long the path is, and the arm can come to rest on what is known at any
/// time.
#pragma once

#include <deque>
#include <vector>

#include "planning/section.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/trajectory/timing_join.hpp"

namespace viapoint::planning {

class PathTimer {
 public:
  /// @param robot must outlive this
  explicit PathTimer(const RobotModel& robot) : robot_(robot) {}

  /// The path goes on.
  void append(const JointPath& path);
  /// Times all that is known, to rest at the end of `certain`.
  /// @param certain what follows in any case: the beginning of what will be appended next
  /// @param not_before when timing() may be left [s]
  /// @returns when timing() as it was is left for what it is now [s]; its end where no way from one
  ///          to the other was found, so that the arm rests there
  double extend(const JointPath& certain, double not_before);
  /// The one before was not left in time, so that the arm rests at its end: times the way from
  /// there. @pre extend() has been called twice or more
  void begin_after_missing();
  /// From where the one before was left, to rest. Empty before the first extend().
  [[nodiscard]] const NumberedTiming& timing() const { return timing_; }
  /// What each piece of timing() allows the tool; empty where none limits it.
  [[nodiscard]] std::vector<ToolLimits> tool() const;
  /// How often the arm had to rest since the path began.
  [[nodiscard]] int stops() const { return stops_; }

 private:
  [[nodiscard]] NumberedTiming time(std::size_t from, const JointPath& certain) const;
  /// The piece of path that a number of timing() lies in.
  [[nodiscard]] const JointPiece& piece(std::size_t number) const;
  /// First piece of path that is timed anew.
  [[nodiscard]] std::size_t window_start(std::size_t overlap) const;
  [[nodiscard]] bool holds(std::span<const TrajectoryPiece> pieces, std::size_t number) const;
  void adopt_certain();
  void begin_after_rest(std::size_t piece, double passed);

  const RobotModel& robot_;
  std::deque<JointPiece> path_;    ///< what is still of use of it
  std::size_t first_ = 0;          ///< how many pieces came before
  NumberedTiming timing_;          ///< numbers count parts of pieces, see path_timer.cpp
  JointPath certain_;              ///< at the end of timing_
  std::size_t certain_first_ = 0;  ///< how many pieces came before
  std::size_t rest_piece_ = 0;     ///< that the timing before timing_ ends in
  double rest_passed_ = 0.0;       ///< of it
  int stops_ = 0;
};

/// A section from rest to rest: as a whole, or, where it is long, in windows. Corners are left
/// empty.
[[nodiscard]] Section time_section(const RobotModel& robot, const JointPath& path);

/// From rest to rest along a path, without windows [s].
[[nodiscard]] double duration_at_rest(const RobotModel& robot, const JointPath& path);

/// Appends of `timing` what lies before `end` [s from its beginning] to `pieces`.
/// @returns how many pieces that is
std::size_t append_until(std::vector<TrajectoryPiece>& pieces,
                         std::span<const TrajectoryPiece> timing, double end);

}  // namespace viapoint::planning
