/// @file
/// What the bind_<module>.cpp files share: the handles Python holds, and the way of arrays across.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/program/motion_program.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint::python {

namespace py = pybind11;

/// A contiguous array of doubles, converted from whatever came.
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Arrays by name, one row a sample.
using Columns = py::typing::Dict<py::str, py::array>;

/// An immutable robot, shared with every planner and motion made from it.
struct RobotHandle {
  RobotPtr robot;
};

/// A move's target; the variant itself would be taken apart by pybind11's converters.
struct TargetHandle {
  Target target;
};

/// A planned motion together with the robot it was planned for.
struct MotionHandle {
  RobotPtr robot;
  std::shared_ptr<const Trajectory> trajectory;
  std::vector<CornerOutcome> corners;
  std::vector<Problem> problems;
  std::vector<ProcessStretch> process_stretches = {};
};

/// Joints from Python: (n,), n <= kMaxJoints, and n == `expected` where that is not negative.
/// @throws MotionError(kBadArgument) naming `name`
[[nodiscard]] JointVector joints_from(const Eigen::VectorXd& values, const char* name,
                                      int expected = -1);
/// A 4x4 pose from Python, projected on a rotation where it is within rounding of one.
[[nodiscard]] Pose pose_from(const Eigen::Matrix4d& matrix);

/// Joint vectors as the rows of one array, (k, n).
[[nodiscard]] Array rows_of(const std::vector<JointVector>& vectors);
/// @throws MotionError(kUncontrolled) for a robot without kinematics
void require_kinematics(const RobotModel& robot);

void bind_error(py::module_& m);
void bind_core(py::module_& m);
void bind_robot(py::module_& m);
void bind_kinematics(py::module_& m, py::class_<RobotHandle>& robot);
void bind_calibration(py::module_& m);
void bind_path(py::module_& m);
void bind_program(py::module_& m);
void bind_planning(py::module_& m);
void bind_motion_file(py::module_& m);
void bind_realtime(py::module_& m);
void bind_rtde(py::module_& m);
void bind_stream(py::module_& m);
/// @param profile the submodule that bind_profile has made
void bind_state_to_state(py::module_& profile);

}  // namespace viapoint::python

/// The textbook laws and the state-to-state profiles, in the submodule `profile`.
void bind_profile(pybind11::module_& m);
