/// @file
/// Splines through or by the points of a move, of the tool or of the joints.
#pragma once

#include <vector>

#include "planning/tool_way.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint::planning {

/// @param tolerance how far the arm may be from the curve's own beginning, where it has one
/// @throws MotionError as way_of of other moves; kDiscontinuous where the arm is not at the start
[[nodiscard]] ToolWay way_of(const SplineMove& move, const RobotModel& robot,
                             const LineTolerance& tolerance, const JointVector& start);

/// The spline of the joints. @param points start and points, resolved
/// @throws MotionError(kDegenerateCurve, kJointLimit, kCouplingLimit, kZeroLength, kBadArgument)
[[nodiscard]] JointPath joint_spline(const SplineMove& move, const RobotModel& robot,
                                     const std::vector<JointVector>& points);

}  // namespace viapoint::planning
