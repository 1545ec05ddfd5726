/// @file
#pragma once

#include <vector>

#include "course.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/corner.hpp"

namespace viapoint::laws {

/// Two legs, the corner between them, and the path that comes of it.
struct CornerCase {
  RobotPtr arm;  ///< null without kinematics
  JointPath before, after;
  Zone zone;
  Corner corner;
  JointPath path;
};

/// Every kind of corner.
[[nodiscard]] std::vector<Subject<CornerCase>> corners();

}  // namespace viapoint::laws
