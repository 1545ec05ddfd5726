// Knots of straight lines with their proven bounds, for study and comparison, and fits of curves.
#include <pybind11/functional.h>

#include <algorithm>
#include <functional>

#include "bindings.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/path/curve_fit.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint::python {
namespace {

/// Knots along a straight tool line, and how far the joints between them stray from it at most.
struct KnotsHandle {
  std::vector<JointVector> knots;
  Deviation bound;
};

/// The proof for knots between which the joints go straight.
Deviation bound_of_lines(const RobotModel& robot, const LineCurve& curve, const TaylorKnots& found,
                         double position, double angle) {
  constexpr double kResolution = 0.01;  // share of the tolerance the bound may lie above the truth
  Deviation worst;
  for (size_t i = 0; i + 1 < found.knots.size(); ++i) {
    const JointPiece piece =
        JointPiece::line(found.knots[i], found.knots[i + 1], found.s[i + 1] - found.s[i]);
    const Deviation here = bound_deviation(robot.forward(), piece, curve, found.s[i],
                                           kResolution * position, kResolution * angle);
    worst.position = std::max(worst.position, here.position);
    worst.angle = std::max(worst.angle, here.angle);
  }
  return worst;
}

KnotsHandle certified_knots(const RobotModel& robot, const Pose& from, const Pose& to,
                            const JointVector& start, double position, double angle) {
  InsertionOptions options;
  options.position_tolerance = position;
  options.angle_tolerance = angle;
  const LineCurve curve(from, to);
  Insertion found = insert_curve(robot.forward(), robot.limits(), curve, start, options);
  return {std::move(found.knots), {found.position_deviation, found.angle_deviation}};
}

KnotsHandle taylor_knots(const RobotModel& robot, const Pose& from, const Pose& to,
                         const JointVector& start, double position, double angle) {
  const LineCurve curve(from, to);
  // Both ends must lie on one branch: the goal is where the line itself arrives.
  const JointVector goal = certified_knots(robot, from, to, start, position, angle).knots.back();
  TaylorKnots found = taylor_insertion(robot.forward(), curve, start, goal, position, angle);
  const Deviation bound = bound_of_lines(robot, curve, found, position, angle);
  return {std::move(found.knots), bound};
}

KnotsHandle insert_knots(const RobotHandle& handle, const Eigen::Matrix4d& pose0,
                         const Eigen::Matrix4d& pose1, const Eigen::VectorXd& near,
                         const std::string& method, double position, double angle) {
  const RobotModel& robot = *handle.robot;
  require_kinematics(robot);
  const Pose from = pose_from(pose0);
  const Pose to = pose_from(pose1);
  const JointVector start =
      robot.inverse().solve_near(from, joints_from(near, "near", robot.joints()));
  if (method == "taylor") return taylor_knots(robot, from, to, start, position, angle);
  return certified_knots(robot, from, to, start, position, angle);
}

py::array_t<double> poses_of(const CurveFit& fit) {
  py::array_t<double> poses({fit.poses.size(), size_t{4}, size_t{4}});
  auto view = poses.mutable_unchecked<3>();
  for (py::ssize_t k = 0; k < view.shape(0); ++k) {
    const Eigen::Matrix4d matrix = fit.poses[static_cast<size_t>(k)].matrix();
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) view(k, row, column) = matrix(row, column);
    }
  }
  return poses;
}

void bind_fit(py::module_& m) {
  py::class_<CurveFit>(m, "PoseFit", "Poses on a curve, and how near the spline through them is.")
      .def_property_readonly("poses", &poses_of, "(k, 4, 4)")
      .def_readonly("at", &CurveFit::at, "Parameter of each pose.")
      .def_property_readonly("deviation", [](const CurveFit& f) { return f.deviation.position; })
      .def_property_readonly("angle_deviation", [](const CurveFit& f) { return f.deviation.angle; })
      .def_readonly("looked_at", &CurveFit::looked_at);
  m.def(
      "fit_function",
      [](const std::function<Eigen::Matrix4d(double)>& gamma, double from, double to,
         double tolerance, double angle_tolerance) {
        return fit_curve([&](double at) { return pose_from(gamma(at)); }, from, to,
                         {tolerance, angle_tolerance});
      },
      py::arg("gamma"), py::kw_only(), py::arg("from_"), py::arg("to"), py::arg("tolerance"),
      py::arg("angle_tolerance"));
  m.def(
      "fit_samples",
      [](const std::vector<Eigen::Matrix4d>& samples, const std::vector<double>& at,
         double tolerance, double angle_tolerance) {
        std::vector<Pose> poses;
        poses.reserve(samples.size());
        for (const Eigen::Matrix4d& sample : samples) poses.push_back(pose_from(sample));
        return fit_curve(poses, at, {tolerance, angle_tolerance});
      },
      py::arg("samples"), py::arg("at"), py::kw_only(), py::arg("tolerance"),
      py::arg("angle_tolerance"), py::call_guard<py::gil_scoped_release>());
}

}  // namespace

void bind_path(py::module_& m) {
  bind_fit(m);
  py::class_<KnotsHandle>(m, "Knots", "Knots along a straight tool line, with a proven bound.")
      .def_property_readonly(
          "q", [](const KnotsHandle& k) { return rows_of(k.knots); }, "(k, n) [rad or m]")
      .def_property_readonly(
          "position_bound", [](const KnotsHandle& k) { return k.bound.position; },
          "The tool strays at most so far from the line [m].")
      .def_property_readonly(
          "angle_bound", [](const KnotsHandle& k) { return k.bound.angle; },
          "The tool turns at most so far from the line's orientation [rad].")
      .def("__len__", [](const KnotsHandle& k) { return k.knots.size(); });
  m.def("insert_knots", &insert_knots, py::arg("robot"), py::arg("pose0"), py::arg("pose1"),
        py::kw_only(), py::arg("near"), py::arg("method"), py::arg("position"), py::arg("angle"),
        py::call_guard<py::gil_scoped_release>());
}

}  // namespace viapoint::python
