/// @file
/// Legs joined by corners: from one stop to the next.
#pragma once

#include <span>
#include <vector>

#include "planning/leg.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::planning {

/// A stretch of motion from rest to rest.
struct Section {
  std::vector<TrajectoryPiece> pieces;
  std::vector<ToolLimits> tool;        ///< one a piece; empty where none limits the tool
  std::vector<CornerOutcome> corners;  ///< of the legs inside, in order
};

/// Rounds every corner whose zone asks for it and gives the whole its timing. A corner that cannot
/// be rounded, or where stopping is quicker, becomes a stop, and its outcome says why.
[[nodiscard]] std::vector<Section> build_sections(const RobotModel& robot,
                                                  std::span<const Leg> legs);

/// Nominal time of pieces [s].
[[nodiscard]] double duration_of(std::span<const TrajectoryPiece> pieces);

}  // namespace viapoint::planning
