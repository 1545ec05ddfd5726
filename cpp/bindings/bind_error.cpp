// Problems as data, and MotionError as one Python class a code (viapoint.errors).
#include <exception>
#include <utility>

#include "bindings.hpp"

namespace viapoint::python {
namespace {

constexpr int kErrorCodes = static_cast<int>(ErrorCode::kInternal) + 1;

ErrorCode code_from(const std::string& name) {
  for (int i = 0; i < kErrorCodes; ++i) {
    const auto code = static_cast<ErrorCode>(i);
    if (to_string(code) == name) return code;
  }
  throw MotionError(ErrorCode::kBadArgument, "\"" + name + "\" is no error code of viapoint.",
                    {"Use one of viapoint._core.error_codes()."});
}

std::vector<std::string> error_codes() {
  std::vector<std::string> names;
  for (int i = 0; i < kErrorCodes; ++i) names.emplace_back(to_string(static_cast<ErrorCode>(i)));
  return names;
}

void raise_in_python(const MotionError& error) {
  const py::object exception =
      py::module_::import("viapoint.errors").attr("from_problem")(py::cast(error.problem()));
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
}

}  // namespace

void bind_error(py::module_& m) {
  py::class_<Problem>(m, "Problem", "One thing that is wrong; fields that do not apply are None.")
      .def(py::init([](const std::string& code, std::string message,
                       std::vector<std::string> ways_out, bool warning, std::optional<int> move,
                       std::string file, std::optional<int> line, std::optional<int> joint,
                       std::optional<double> time, std::optional<double> share,
                       std::optional<double> value, std::optional<double> limit) {
             return Problem{warning ? Severity::kWarning : Severity::kError,
                            code_from(code),
                            std::move(message),
                            std::move(ways_out),
                            move,
                            std::move(file),
                            line,
                            joint,
                            time,
                            share,
                            value,
                            limit};
           }),
           py::arg("code"), py::arg("message"), py::kw_only(),
           py::arg("ways_out") = std::vector<std::string>{}, py::arg("warning") = false,
           py::arg("move") = py::none(), py::arg("file") = "", py::arg("line") = py::none(),
           py::arg("joint") = py::none(), py::arg("time") = py::none(),
           py::arg("share") = py::none(), py::arg("value") = py::none(),
           py::arg("limit") = py::none())
      .def_property_readonly(
          "code", [](const Problem& p) { return std::string(to_string(p.code)); },
          "Stable lower-case name, e.g. \"joint_limit\".")
      .def_property_readonly(
          "warning", [](const Problem& p) { return p.severity == Severity::kWarning; },
          "True for a warning, False for an error.")
      .def_readonly("message", &Problem::message, "What was wrong and the allowed range.")
      .def_readonly("ways_out", &Problem::ways_out, "What would make it right.")
      .def_readonly("move", &Problem::move, "Index of the move in its program, from 0.")
      .def_readonly("file", &Problem::file, "Source of the move, or the file that was read.")
      .def_readonly("line", &Problem::line, "Line in `file`, from 1.")
      .def_readonly("joint", &Problem::joint, "Joint, from 0.")
      .def_readonly("time", &Problem::time, "[s] from the motion's start.")
      .def_readonly("share", &Problem::share, "Share of the leg where it happens, 0 to 1.")
      .def_readonly("value", &Problem::value, "The offending value [SI, rad].")
      .def_readonly("limit", &Problem::limit, "What it was held against [SI, rad].")
      .def("describe", &Problem::describe, "Where, what and the ways out, in one text.")
      .def("__str__", &Problem::describe)
      .def("__repr__", [](const Problem& p) {
        return "<Problem " + std::string(to_string(p.code)) + ": " + p.message + ">";
      });
  m.def("error_codes", &error_codes, "Every error code's name, in the order of the C++ enum.");

  // pybind11 takes a plain function of a value. NOLINTNEXTLINE(performance-unnecessary-value-param)
  py::register_exception_translator([](std::exception_ptr pointer) {
    if (!pointer) return;
    try {
      std::rethrow_exception(std::move(pointer));
    } catch (const MotionError& error) {
      raise_in_python(error);
    }
  });
}

}  // namespace viapoint::python
