// Arrays across the border, poses and atomic files.
#include <string_view>
#include <variant>

#include "bindings.hpp"
#include "viapoint/core/atomic_file.hpp"

namespace viapoint::python {

JointVector joints_from(const Eigen::VectorXd& values, const char* name, int expected) {
  const auto size = static_cast<int>(values.size());
  if (size < 1 || size > kMaxJoints) {
    throw MotionError(ErrorCode::kBadArgument, std::string(name) + " has " + std::to_string(size) +
                                                   " values; allowed are 1 to " +
                                                   std::to_string(kMaxJoints) + ".");
  }
  if (expected >= 0 && size != expected) {
    throw MotionError(ErrorCode::kBadArgument, std::string(name) + " has " + std::to_string(size) +
                                                   " values; the robot has " +
                                                   std::to_string(expected) + " joints.");
  }
  if (!values.allFinite()) {
    throw MotionError(ErrorCode::kBadArgument,
                      std::string(name) + " holds NaN or infinity; all values must be finite.");
  }
  return values;
}

Pose pose_from(const Eigen::Matrix4d& matrix) { return checked_pose(matrix).pose; }

void bind_core(py::module_& m) {
  m.attr("MAX_JOINTS") = kMaxJoints;
  m.def(
      "checked_pose",
      [](const Eigen::Matrix4d& matrix) {
        const CheckedPose checked = checked_pose(matrix);
        return std::pair<Eigen::Matrix4d, double>(checked.pose.matrix(), checked.correction);
      },
      py::arg("matrix"),
      "The pose with its rotation made exact, and the largest element by which it was changed.");
  m.def(
      "write_file_atomically",
      [](const std::string& path, const std::variant<py::bytes, std::string>& content) {
        const auto* bytes = std::get_if<py::bytes>(&content);
        // Neither can change while the writer holds it: both are immutable in Python, or a copy.
        const std::string_view view =
            bytes != nullptr ? std::string_view(*bytes) : std::get<std::string>(content);
        const py::gil_scoped_release release;
        write_file_atomically(path, view);
      },
      py::arg("path"), py::arg("content"),
      "Writes a whole file: a crash leaves the old content or the new, never a part.");
  py::class_<AtomicFile>(m, "AtomicFile",
                         "A file in pieces: a crash leaves the old content or the new.")
      .def(py::init<const std::string&>(), py::arg("path"))
      .def(
          "write",
          [](AtomicFile& file, const py::bytes& piece) {
            const std::string_view view = piece;
            const py::gil_scoped_release release;
            file.write(view);
          },
          py::arg("piece"), "Writes on, beside the old content.")
      .def("commit", &AtomicFile::commit, py::call_guard<py::gil_scoped_release>(),
           "What was written takes the place of the old content.")
      .def("discard", &AtomicFile::discard, "Removes what was written; nothing after commit().");
  m.def("read_file", &read_file, py::arg("path"), py::call_guard<py::gil_scoped_release>(),
        "The whole text of a file.");
}

}  // namespace viapoint::python
