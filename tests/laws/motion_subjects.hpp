/// @file
#pragma once

#include <vector>

#include "course.hpp"
#include "viapoint/core/joint_limits.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint::laws {

/// A motion, the limits it was made for, and where it should lead.
struct MotionCase {
  Trajectory trajectory;
  JointLimits limits;
  JointVector first, last;
};

/// Every motion that may run: it keeps its limits and is at rest at both ends.
[[nodiscard]] std::vector<Subject<MotionCase>> sound_motions();
/// Motions for study only: smooth, but with no promise about limits.
[[nodiscard]] std::vector<Subject<MotionCase>> study_motions();
/// Both lists.
[[nodiscard]] std::vector<Subject<MotionCase>> all_motions();
/// The same as courses over time.
[[nodiscard]] std::vector<Subject<Course>> motion_courses();

}  // namespace viapoint::laws
