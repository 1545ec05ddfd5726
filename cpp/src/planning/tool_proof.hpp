/// @file
/// Holds the finished pieces of a motion against what the program allows the tool.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "planning/process_proof.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/trajectory/tool_certificate.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::planning {

class ToolProof {
 public:
  /// @param limits one a piece, or none where the tool is not limited
  /// @param time where the first piece begins [s]
  void add(const RobotModel& robot, std::span<const TrajectoryPiece> pieces,
           std::span<const ToolLimits> limits, double time);
  [[nodiscard]] const ToolExtrema& extrema() const { return certifier_.extrema(); }
  /// Which limits hold when.
  [[nodiscard]] std::vector<ToolSpan> take_spans() { return std::move(spans_); }

  /// Where process speeds are not held.
  [[nodiscard]] std::vector<ProcessStretch> take_stretches() { return process_.take(); }

 private:
  ToolCertifier certifier_;
  ProcessProof process_;
  std::vector<ToolSpan> spans_;
};

/// Adds the pieces that have a process speed. Arguments as of ToolProof::add().
/// @returns where the last piece ends [s]
double add_process(ProcessProof& process, const RobotModel& robot,
                   std::span<const TrajectoryPiece> pieces, std::span<const ToolLimits> limits,
                   double time);

/// What the extrema break, worst first.
[[nodiscard]] std::vector<Problem> problems_of(const ToolExtrema& extrema);

}  // namespace viapoint::planning
