/// @file
#pragma once

#include <memory>
#include <vector>

#include "course.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/path/task_curve.hpp"

namespace viapoint::laws {

/// A path in joint space, and where it should lead.
struct PathCase {
  JointPath path;
  JointVector first, last;
};

/// A path that was made to follow a tool curve.
struct ToolPathCase {
  JointPath path;
  JointVector first, last;
  RobotPtr arm;
  std::shared_ptr<const TaskCurve> curve;
  Insertion insertion;
  InsertionOptions options;
};

/// Every path of its own kind.
[[nodiscard]] std::vector<Subject<PathCase>> joint_paths();
/// Every path that follows a tool curve.
[[nodiscard]] std::vector<Subject<ToolPathCase>> tool_paths();
/// Both lists, and the paths with corners.
[[nodiscard]] std::vector<Subject<PathCase>> all_paths();
/// The same as courses.
[[nodiscard]] std::vector<Subject<Course>> path_courses();

/// Every curve of the tool.
[[nodiscard]] std::vector<Subject<std::shared_ptr<const TaskCurve>>> tool_curves();

}  // namespace viapoint::laws
