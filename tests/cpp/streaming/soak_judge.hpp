/// @file
/// Holds every cycle of an arm in virtual time against what is promised of it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "streaming/state_table.hpp"
#include "viapoint/core/joint_limits.hpp"
#include "viapoint/realtime/drive.hpp"
#include "viapoint/realtime/motion_log.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// Sees what the drive was told, which is all that counts, and what state the run said it was in.
/// The first thing that is wrong is kept in words.
class SoakJudge {
 public:
  SoakJudge(JointLimits limits, double cycle, const StateTable& table);

  /// Where a run is on its way.
  struct Progress {
    double nominal_time;  ///< [s]
    std::size_t way;      ///< which of those of judge_run() it follows
  };
  /// One cycle. @param state of the run, or of the arm without one
  /// @param progress of the run; none without one
  void see(const Setpoint& setpoint, RunState state, std::optional<Progress> progress);
  /// A run has ended that left this log. Its cycles are held against both, and its end against how
  /// it was told to end.
  /// @param ways what the run had to follow, one motion, or more where it got longer on the way
  /// @param stop_told a stop was commanded, by a call or by an input
  void judge_run(std::span<const Trajectory> ways, const std::vector<LogRecord>& log,
                 bool stop_told);

  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] std::uint64_t cycles() const { return cycles_; }
  [[nodiscard]] std::uint64_t seen(RunState state) const;
  /// Largest share of a joint's velocity, acceleration or jerk, between the cycles too.
  [[nodiscard]] double worst_share() const { return worst_share_; }
  /// Largest distance of any joint from the path while it is to be on it [rad or m].
  [[nodiscard]] double worst_deviation() const { return worst_deviation_; }

 private:
  /// A cycle of the run under way.
  struct Cycle {
    RunState state;
    Progress progress;
    std::uint64_t outputs;
    JointVector q;
  };

  void hold_limits(const Setpoint& setpoint);
  void hold_path(std::span<const Trajectory> ways);
  void hold_outputs(std::span<const Trajectory> ways);
  void hold_rates(std::span<const Trajectory> ways, const std::vector<LogRecord>& log);
  void note(const std::string& what);

  JointLimits limits_;
  double cycle_;
  const StateTable& table_;
  Setpoint last_;
  RunState last_state_ = RunState::kIdle;
  std::vector<Cycle> run_;
  std::uint64_t outputs_before_ = 0;  ///< the run
  std::uint64_t cycles_ = 0;
  std::map<RunState, std::uint64_t> seen_;
  double worst_share_ = 0.0;
  double worst_deviation_ = 0.0;
  std::string problem_;
};

}  // namespace viapoint
