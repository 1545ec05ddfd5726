/// @file
/// From wishes for the tool's speed and acceleration to ceilings on a piece's rate.
#pragma once

#include <optional>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint::planning {

/// What the tool may do along a piece; empty: as fast as the joints allow.
struct ToolWishes {
  std::optional<double> speed;         ///< [m/s]
  std::optional<double> acceleration;  ///< [m/s²]
};

/// Lowers rate_limit and rate_change_limit of the piece so that ‖ṗ‖ <= speed and ‖p̈‖ <=
/// acceleration at the tool point wherever the timing keeps them and the joints' velocities:
/// ṗ = p'ṡ, p̈ = p''ṡ² + p's̈, with suprema of ‖p'‖ and ‖p''‖ over subintervals by Taylor expansion
/// about their middles and a bounded remainder. @pre robot.has_kinematics()
void limit_tool(const RobotModel& robot, JointPiece& piece, const ToolWishes& wishes);

}  // namespace viapoint::planning
