/// @file
/// Where a process speed is proven to be held, and what rules where it is not.
#pragma once

#include <vector>

#include "planning/tool_pace.hpp"
#include "viapoint/core/joint_limits.hpp"
#include "viapoint/path/tool_rates.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::planning {

/// The pieces of a motion come in the order of time, those without a process speed left out.
class ProcessProof {
 public:
  /// @param time where the piece begins [s]
  void add(const JointLimits& limits, const TrajectoryPiece& piece, const ToolRates& rates,
           double time);
  /// What was not held since the last call; nothing follows.
  [[nodiscard]] std::vector<ProcessStretch> take();
  /// The same where more follows: a stretch that may go on is left for the next call.
  [[nodiscard]] std::vector<ProcessStretch> take_ended();

 private:
  void begin(const TrajectoryPiece& piece, double speed, double time);
  void end();
  /// Returns what holding the speed along the piece would take of a limit.
  Ruling judge(const JointLimits& limits, const TrajectoryPiece& piece, const ToolRates& rates);

  std::vector<ProcessStretch> stretches_;
  bool open_ = false;       ///< the last of stretches_ may go on
  bool rests_ = false;      ///< the arm starts or stops in it
  Ruling holding_, using_;  ///< what holding the speed would take of a limit, and what is taken
  double unforced_ = 0.0;   ///< the way in it at a speed kept below any that a limit asks for [m]
  double time_ = -1.0, way_ = 0.0;  ///< where the last piece ended [s], and the way up to there [m]
};

[[nodiscard]] Problem warning_of(const ProcessStretch& stretch);

}  // namespace viapoint::planning
