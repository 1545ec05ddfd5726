// Tools and frames from touched points.
#include "bindings.hpp"
#include "viapoint/kinematics/calibration.hpp"

namespace viapoint::python {
namespace {

std::vector<Pose> poses_from(const std::vector<Eigen::Matrix4d>& matrices) {
  std::vector<Pose> poses;
  poses.reserve(matrices.size());
  for (const Eigen::Matrix4d& matrix : matrices) poses.push_back(pose_from(matrix));
  return poses;
}

std::vector<Eigen::Vector3d> points_from(const Eigen::MatrixX3d& rows) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& row : rows.rowwise()) points.emplace_back(row.transpose());
  return points;
}

}  // namespace

void bind_calibration(py::module_& m) {
  py::class_<Fit>(m, "Fit", "How well touched points agree with what was found from them.")
      .def_property_readonly(
          "residuals",
          [](const Fit& f) {
            return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
                f.residuals.data(), static_cast<Eigen::Index>(f.residuals.size())));
          },
          "Of each touched point, (n,) [m].")
      .def_readonly("rms", &Fit::rms, "Of the residuals [m].")
      .def_readonly("largest", &Fit::largest, "[m].")
      .def_readonly("worst", &Fit::worst, "Index of the point that has the largest residual.");
  py::class_<TcpCalibration>(m, "TcpCalibration", "The tool's point, from touching one point.")
      .def_property_readonly(
          "tcp", [](const TcpCalibration& c) { return Eigen::Vector3d(c.tcp); },
          "The tool's point in the flange frame, (3,) [m].")
      .def_property_readonly(
          "pose",
          [](const TcpCalibration& c) {
            return Eigen::Matrix4d(Pose(Eigen::Translation3d(c.tcp)).matrix());
          },
          "pose_flange_tool of a tool that stands as the flange does, (4, 4) [m].")
      .def_property_readonly(
          "point", [](const TcpCalibration& c) { return Eigen::Vector3d(c.point); },
          "The fixed point in the base frame, (3,) [m].")
      .def_readonly("fit", &TcpCalibration::fit, "How well the touches agree.")
      .def_readonly("sensitivity", &TcpCalibration::sensitivity,
                    "Error of the TCP where it is known least, over that of a touch.")
      .def_readonly("uncertainty", &TcpCalibration::uncertainty,
                    "Standard deviation of the TCP where it is known least, by the residuals [m].");
  py::class_<ToolCalibration>(m, "ToolCalibration", "Point and orientation of a tool.")
      .def_property_readonly(
          "pose",
          [](const ToolCalibration& c) { return Eigen::Matrix4d(c.pose_flange_tool.matrix()); },
          "pose_flange_tool, (4, 4) [m].")
      .def_readonly("tcp", &ToolCalibration::tcp, "Where its point is, and how well that is known.")
      .def_readonly("angle", &ToolCalibration::angle,
                    "Between the ways that showed x and z [rad]; a right angle but for errors.");
  py::class_<FrameFit>(m, "FrameFit", "A frame whose points are known beforehand.")
      .def_property_readonly(
          "pose", [](const FrameFit& f) { return Eigen::Matrix4d(f.pose_base_frame.matrix()); },
          "pose_base_frame, (4, 4) [m].")
      .def_readonly("fit", &FrameFit::fit, "How well the points agree.");
  m.def(
      "calibrate_tcp",
      [](const std::vector<Eigen::Matrix4d>& flanges) {
        return calibrate_tcp(poses_from(flanges));
      },
      py::arg("flanges"));
  m.def(
      "calibrate_tool",
      [](const std::vector<Eigen::Matrix4d>& flanges, const Eigen::Matrix4d& along_x,
         const Eigen::Matrix4d& along_z) {
        return calibrate_tool(poses_from(flanges), pose_from(along_x), pose_from(along_z));
      },
      py::arg("flanges"), py::arg("along_x"), py::arg("along_z"));
  m.def(
      "frame_from_points",
      [](const Eigen::Vector3d& origin, const Eigen::Vector3d& on_x, const Eigen::Vector3d& on_xy) {
        return Eigen::Matrix4d(frame_from_points(origin, on_x, on_xy).matrix());
      },
      py::arg("origin"), py::arg("on_x"), py::arg("on_xy"));
  m.def(
      "frame_from_known_points",
      [](const Eigen::MatrixX3d& known, const Eigen::MatrixX3d& touched) {
        return frame_from_known_points(points_from(known), points_from(touched));
      },
      py::arg("known"), py::arg("touched"));
}

}  // namespace viapoint::python
